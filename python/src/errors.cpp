#include <nanobind/stl/string.h>

#include "bindings.hpp"
#include "interrupted.hpp"
#include "prowl/error.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl::python {

namespace nb = nanobind;

namespace {

nb::tuple also(nb::handle error, PyObject* kind) { return nb::make_tuple(error, nb::handle(kind)); }

void document(nb::handle type, const char* text) { nb::setattr(type, "__doc__", nb::str(text)); }

PyObject* interrupted_type = nullptr;  // the module is loaded once per process

}  // namespace

void raise_interrupted(const char* message, nb::handle plan, nb::handle sweep) {
  const nb::object error = nb::handle(interrupted_type)(message);
  nb::setattr(error, "plan", plan);
  nb::setattr(error, "sweep", sweep);
  PyErr_SetObject(interrupted_type, error.ptr());
  throw nb::python_error();
}

/// The hierarchy of prowl/error.hpp; each class also derives from the matching Python exception.
void bind_errors(nb::module_& module) {
  const nb::exception<Error> error(module, "Error", PyExc_RuntimeError);
  document(error, "Base of all exceptions of Prowl. Messages contain the error, its location, and the remedy.");
  const nb::exception<InputError> input(module, "InputError", also(error, PyExc_ValueError));
  document(input, "Invalid input of the caller or a file: unknown name, wrong shape, value out of range.");
  const nb::exception<FileError> file(module, "FileError", also(error, PyExc_OSError));
  document(file, "A file or a folder cannot be read or written.");
  const nb::exception<NumericalError> numerical(module, "NumericalError", also(error, PyExc_ArithmeticError));
  document(numerical, "A model evaluation gave NaN or infinity, or a matrix is singular.");
  nb::register_exception_translator(
      [](const std::exception_ptr& thrown, void* type) {
        try {
          std::rethrow_exception(thrown);
        } catch (
            const TrackerError& tracker_error) {  // outside the hierarchy, as the tracker runs on robots without Prowl
          PyErr_SetString(static_cast<PyObject*>(type), tracker_error.what());
        }
      },
      input.ptr());

  const std::string name = nb::cast<std::string>(module.attr("__name__")) + ".Interrupted";
  const nb::object interrupted = nb::steal(PyErr_NewException(name.c_str(), PyExc_KeyboardInterrupt, nullptr));
  document(interrupted,
           "Ctrl-C, or the stop button of a notebook, while solve() or sweep() ran: a KeyboardInterrupt. Its attribute "
           "`plan` is\n"
           "the best motion so far, with status \"interrupted\"; `sweep` contains the simulations that have finished. "
           "Each is None\n"
           "if there is none.");
  module.attr("Interrupted") = interrupted;
  interrupted_type = interrupted.ptr();
}

}  // namespace prowl::python

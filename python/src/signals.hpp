#pragma once

#include <nanobind/nanobind.h>

namespace prowl::python {

/// Lets Python look whether there was a Ctrl-C, from code that runs without the GIL. Throws nanobind::python_error if so
/// (that is, whatever the handler of the signal raised). Only Python's main thread handles signals.
inline void check_signals() {
  const nanobind::gil_scoped_acquire in_python;
  if (PyErr_CheckSignals() != 0) throw nanobind::python_error();
}

/// The same at every so-many-th call.
class SignalCheck {
 public:
  explicit SignalCheck(int every) : every_(every) {}
  void operator()() {
    if (++calls_ % every_ == 0) check_signals();
  }

 private:
  int every_, calls_ = 0;
};

}  // namespace prowl::python

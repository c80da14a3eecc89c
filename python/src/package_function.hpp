#pragma once

#include <nanobind/nanobind.h>

#include <utility>

namespace prowl::python {

/// Calls a Python function of the package. Imports it at the call, as the package imports this
/// module first.
template <class... Arguments>
nanobind::object call_package(const char* module, const char* function, Arguments&&... arguments) {
  return nanobind::module_::import_(module).attr(function)(std::forward<Arguments>(arguments)...);
}

}  // namespace prowl::python

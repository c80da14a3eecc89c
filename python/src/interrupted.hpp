#pragma once

#include <nanobind/nanobind.h>

namespace prowl::python {

/// Raises prowl.Interrupted with what there is so far: a plan or a sweep, None for the other.
[[noreturn]] void raise_interrupted(const char* message, nanobind::handle plan, nanobind::handle sweep);

}  // namespace prowl::python

#pragma once

#include <nanobind/nanobind.h>

namespace prowl::python {

/// Raises prowl.Interrupted with this plan.
[[noreturn]] void raise_interrupted(nanobind::handle plan);

}  // namespace prowl::python

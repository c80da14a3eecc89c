#pragma once

#include <nanobind/nanobind.h>

#include "prowl/online/online_run.hpp"

namespace prowl::python {

/// Calls a function of the user's own with a prowl.OnlineMoment at `rate` times a second of the run.
OnlineWatcher watcher_of(nanobind::callable function, double rate);

}  // namespace prowl::python

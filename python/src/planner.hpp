#pragma once

#include <nanobind/nanobind.h>

#include "prowl/online/online_run.hpp"

namespace prowl::python {

/// Asks a function of the user's own: MotionRequest -> MotionSteps or None.
Planner planner_of(const RobotModel& robot, nanobind::callable function);

}  // namespace prowl::python

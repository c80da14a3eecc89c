#pragma once

// Reads [tracking] of a task file. Not installed: exposes toml++.
#include "prowl/task_file/toml/toml_value.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {

/// Default options of the robot, overridden by the file.
TrackingOptions read_tracking(const TomlTable& root, const RobotModel& robot);

}  // namespace prowl

#pragma once

// Reads [tracking] of a task file. Not installed: shows toml++.
#include "prowl/task_file/toml/toml_value.hpp"
#include "prowl/tracking/tracking_options.hpp"

namespace prowl {

/// The defaults of the robot with what the file says in their place.
TrackingOptions read_tracking(const TomlTable& root, const RobotModel& robot);

}  // namespace prowl

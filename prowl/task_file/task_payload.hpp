#pragma once

#include "prowl/model/robot_model.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// The robot with what [[payload]] fixes to it.
RobotModel with_payloads(const TomlTable& root, RobotModel robot);

}  // namespace prowl

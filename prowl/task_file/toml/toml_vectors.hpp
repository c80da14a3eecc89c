#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/model/robot_model.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// A key that is a number for all three axes or a list of three; `values` stays as it is where there is no such key.
void read_axes(const TomlTable& table, const std::string& key, Eigen::Ref<Eigen::VectorXd> values);

/// A key that is a number for all joints or a table { joint = number }, which leaves the others as they are.
void read_joints(const TomlTable& table, const std::string& key, const RobotModel& robot,
                 Eigen::Ref<Eigen::VectorXd> values);

}  // namespace prowl

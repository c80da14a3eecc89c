#pragma once

#include <Eigen/Core>
#include <string>

#include "prowl/model/robot_model.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {

/// Reads a key with one number for all axes or a list of three; without the key `values` (3) is
/// unchanged.
void read_axes(const TomlTable& table, const std::string& key, Eigen::Ref<Eigen::VectorXd> values);

/// Reads a key with one number for all joints or a table { joint = number }; other joints of
/// `values` (nu) are unchanged.
void read_joints(const TomlTable& table, const std::string& key, const RobotModel& robot,
                 Eigen::Ref<Eigen::VectorXd> values);

}  // namespace prowl

#include "prowl/task_file/toml/toml_vectors.hpp"

#include <algorithm>

namespace prowl {

void read_axes(const TomlTable& table, const std::string& key, Eigen::Ref<Eigen::VectorXd> values) {
  const auto value = table.find(key);
  if (!value) return;
  if (value->is_list()) {
    values = value->as_vector3();
  } else {
    values.setConstant(value->as_number());
  }
}

void read_joints(const TomlTable& table, const std::string& key, const RobotModel& robot,
                 Eigen::Ref<Eigen::VectorXd> values) {
  const auto value = table.find(key);
  if (!value) return;
  if (!value->is_table()) {
    values.setConstant(value->as_number());
    return;
  }
  const std::vector<std::string>& names = robot.joint_names();
  for (const auto& [name, entry] : value->as_named_values(names, "joint")) {
    values(std::find(names.begin(), names.end(), name) - names.begin()) = entry.as_number();
  }
}

}  // namespace prowl

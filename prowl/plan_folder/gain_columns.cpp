#include "prowl/plan_folder/gain_columns.hpp"

#include <fmt/format.h>

namespace prowl {

std::vector<std::string> gain_columns(const RobotModel& robot) {
  std::vector<std::string> columns;
  const auto add_axes = [&columns](const char* quantity, const char* unit) {
    for (const char axis : {'x', 'y', 'z'}) columns.push_back(fmt::format("base_{}{}_{}", quantity, axis, unit));
  };
  add_axes("p", "Npm");
  add_axes("r", "Nmprad");
  for (const std::string& name : robot.joint_names()) columns.push_back(fmt::format("q_{}_Nmprad", name));
  add_axes("v", "Nspm");
  add_axes("w", "Nmsprad");
  for (const std::string& name : robot.joint_names()) columns.push_back(fmt::format("v_{}_Nmsprad", name));
  return columns;
}

}  // namespace prowl

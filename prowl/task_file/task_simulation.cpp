#include "prowl/task_file/task_simulation.hpp"

#include <algorithm>

namespace prowl {

TaskSimulation read_simulation(const TomlTable& root) {
  TaskSimulation simulation;
  const auto table = root.find_table("simulation");
  if (!table) return simulation;
  const auto read_most = [&](const char* key, double& value) {
    if (const auto number = table->find(key)) value = std::min(value, number->as_number());
  };
  SuccessCriteria& success = simulation.success;
  read_most("base_position_m", success.position);
  read_most("base_angle_rad", success.angle);
  read_most("slip_m", success.distance);
  if (const auto number = table->find("rest_s")) success.rest = std::max(success.rest, number->as_number());
  if (const auto number = table->find("friction")) simulation.friction = number->as_number();
  return simulation;
}

}  // namespace prowl

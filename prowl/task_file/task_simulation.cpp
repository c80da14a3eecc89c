#include "prowl/task_file/task_simulation.hpp"

namespace prowl {

TaskSimulation read_simulation(const TomlTable& root) {
  TaskSimulation simulation;
  const auto table = root.find_table("simulation");
  if (!table) return simulation;
  const auto read = [&](const char* key, auto& value) {
    if (const auto number = table->find(key)) value = number->as_number();
  };
  read("base_position_m", simulation.success.position);
  read("base_angle_rad", simulation.success.angle);
  read("slip_m", simulation.success.slip);
  read("rest_s", simulation.success.rest);
  read("friction", simulation.friction);
  return simulation;
}

}  // namespace prowl

#include "prowl/task_file/task_robust.hpp"

namespace prowl {

std::optional<Disturbances> read_robust(const TomlTable& root, const MotionProblem& problem, bool asked) {
  const auto table = root.find_table("robust");
  if (!table && !asked) return std::nullopt;
  if (problem.cycle) {
    const std::string why = "strides that repeat have no robust plan";
    if (table) table->value().fail(why + "; need gait.periodic = false");
    root.need("gait").fail(why + " (--robust); need gait.periodic = false");
  }
  Disturbances sizes = default_disturbances(problem.robot);
  if (!table) return sizes;
  const auto read = [&](const char* key, double& size) {
    if (const auto value = table->find(key)) size = value->as_number();
  };
  read("base_position_m", sizes.base_position);
  read("base_angle_rad", sizes.base_angle);
  read("base_velocity_mps", sizes.base_velocity);
  read("base_rate_radps", sizes.base_rate);
  read("mass", sizes.mass);
  read("center_m", sizes.center);
  read("friction", sizes.friction);
  read("push_mps", sizes.push);
  read("push_s", sizes.push_duration);
  return sizes;
}

}  // namespace prowl

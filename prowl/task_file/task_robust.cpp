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
  for (const DisturbanceKey& key : kDisturbanceKeys) {
    if (const auto value = table->find(key.name)) sizes.*key.size = value->as_number();
  }
  return sizes;
}

}  // namespace prowl

#include "prowl/task_file/task_reference.hpp"

#include <fmt/format.h>

#include <memory>
#include <utility>

#include "prowl/model/robot_frame.hpp"
#include "prowl/task_file/reference_csv.hpp"
#include "prowl/task_file/toml/toml_vectors.hpp"

namespace prowl {

namespace {

ReferenceWeights read_weights(const TomlTable& table, const RobotModel& robot) {
  ReferenceWeights weights;
  Eigen::VectorXd position = weights.base_position;
  read_axes(table, "base_position", position);
  weights.base_position = position;
  if (const auto weight = table.find("base_orientation")) weights.base_orientation = weight->as_number();
  weights.joint_position.setZero(robot.nu());
  read_joints(table, "joint_position", robot, weights.joint_position);
  for (const TomlTable& entry : table.find_tables("frame")) {
    const TomlValue frame = entry.need("frame");
    weights.frames.push_back({frame.as_text(), entry.need("weight").as_number()});
    try {
      robot_frame(robot, weights.frames.back().name);
    } catch (const InputError& error) {
      frame.fail(error.what());
    }
  }
  return weights;
}

/// Costs of a reference are functions of the time.
void check_durations(const TomlTable& table, const MotionProblem& problem) {
  for (const Phase& phase : problem.phases) {
    if (phase.duration.is_fixed()) continue;
    table.value().fail(
        fmt::format("phase '{}' has a free duration, which shifts the reference; need fixed durations", phase.name));
  }
  if (problem.cycle && problem.cycle->count > 1)
    table.value().fail("strides that repeat follow no reference; need gait.periodic = false");
}

}  // namespace

std::optional<SourceText> read_reference(const TomlTable& root, const std::filesystem::path& folder,
                                         const std::optional<SourceText>& stored, MotionProblem& problem) {
  const auto table = root.find_table("reference");
  if (!table) return std::nullopt;
  const TomlValue file = table->need("file");
  const std::string name = file.as_text();
  const ReferenceWeights weights = read_weights(*table, problem.robot);
  check_durations(*table, problem);
  SourceText source;
  std::vector<TermUse> costs;
  try {
    source = stored ? *stored : read_text_file((folder / name).lexically_normal(), kLongestReference);
    auto motion = std::make_shared<const ReferenceMotion>(read_reference_csv(problem.robot, source));
    costs = reference_costs(problem.robot, *motion, weights, static_cast<int>(problem.phases.size()));
    problem.reference = std::move(motion);
  } catch (const InputError& error) {
    file.fail(error.what());
  }
  if (costs.empty()) table->value().fail("weighs nothing; need one positive weight");
  for (TermUse& cost : costs) problem.terms.push_back(std::move(cost));
  return source;
}

}  // namespace prowl

#include "prowl/transcription/shift_horizon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "prowl/error.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/remesh.hpp"

namespace prowl {
namespace {

void check_nodes(const MotionProblem& problem, const Trajectory& motion) {
  if (problem.phases.front().intervals < 2) {
    throw InputError("shift_horizon: the first phase has one interval; need two or more");
  }
  const Mesh mesh = make_mesh(problem);
  const bool fits = std::ranges::equal(motion.nodes, mesh.nodes, {}, &TrajectoryPoint::phase, &MeshNode::phase);
  if (!fits) {
    throw InputError(
        fmt::format("shift_horizon: the motion has {} nodes, the problem's mesh {}, or they are of other phases",
                    motion.nodes.size(), mesh.nodes.size()));
  }
}

/// Both bounds move with the duration; where the shortest one is used up, what the motion has left of the phase is
/// allowed.
Duration longer(const Duration& duration, double by, double planned) {
  if (duration.is_fixed()) return {planned + by, planned + by};
  return {duration.min + by > 0.0 ? duration.min + by : std::min(duration.min, planned + by), duration.max + by};
}

/// The first interval goes; what comes at the end is as long as the last one. A single phase keeps its length: what
/// goes at its start comes back at its end.
void shift_intervals(std::vector<Phase>& phases) {
  Steps first = steps_with(phases.front(), phases.front().intervals);
  if (phases.size() == 1) {
    first.push_back(first.front());
  } else {
    Steps last = steps_with(phases.back(), phases.back().intervals);
    last.push_back(last.back());
    set_steps(phases.back(), last);
  }
  first.erase(first.begin());
  set_steps(phases.front(), first);
}

/// Goals of the first phase come one node earlier, those at the end of the last phase stay there.
void shift_conditions(const MotionProblem& before, const TrajectoryPoint& start, MotionProblem& problem) {
  problem.boundary_conditions.clear();
  BoundaryCondition first = BoundaryCondition::unbounded(before.robot, before.start().name, {0, 0}, start.q);
  first.configuration_lower.setZero();
  first.configuration_upper.setZero();
  first.velocity_lower = first.velocity_upper = start.v;
  problem.boundary_conditions.push_back(std::move(first));
  const int last = static_cast<int>(before.phases.size()) - 1;
  const NodeRef end{last, before.phases.back().intervals};
  for (auto goal = before.boundary_conditions.begin() + 1; goal != before.boundary_conditions.end(); ++goal) {
    NodeRef at = goal->at == end ? NodeRef{last, end.node + 1} : goal->at;
    if (at.phase == 0) --at.node;
    if (at.phase == 0 && at.node <= 0) continue;  // it is over
    problem.boundary_conditions.push_back(*goal);
    problem.boundary_conditions.back().at = at;
  }
}

/// The first stage has no states: what belongs to their bounds is not in its multipliers. Of the rest the next stage
/// knows better.
StageMultipliers first_stage(const StageMultipliers& first, const StageMultipliers& second) {
  const auto later = [](const Eigen::VectorXd& of_first, const Eigen::VectorXd& of_second) {
    return of_first.size() == of_second.size() ? of_second : of_first;
  };
  return {later(first.next, second.next), later(first.equalities, second.equalities),
          later(first.inequalities, second.inequalities)};
}

}  // namespace

ShiftedHorizon shift_horizon(const MotionProblem& problem, const Trajectory& motion,
                             const std::vector<StageMultipliers>& multipliers) {
  check_nodes(problem, motion);
  const std::vector<TrajectoryPoint>& nodes = motion.nodes;
  const double first_step = nodes[1].time - nodes[0].time;
  ShiftedHorizon shifted{problem, {}, {}};
  std::vector<Phase>& phases = shifted.problem.phases;
  const auto planned = [&](int phase) {
    const auto ends = std::ranges::equal_range(nodes, phase, {}, &TrajectoryPoint::phase);
    return std::prev(ends.end())->time - ends.begin()->time;
  };
  const int last = static_cast<int>(phases.size()) - 1;
  const double last_step = last > 0 ? nodes.back().time - nodes[nodes.size() - 2].time : first_step;
  shift_intervals(phases);
  if (last > 0) {
    phases.front().duration = longer(problem.phases.front().duration, -first_step, planned(0));
    phases.back().duration = longer(problem.phases.back().duration, last_step, planned(last));
  }
  shift_conditions(problem, nodes[1], shifted.problem);

  shifted.start_from.nodes.assign(nodes.begin() + 1, nodes.end());
  shifted.start_from.nodes.push_back(nodes.back());
  shifted.start_from.nodes.back().time += last_step;
  for (TrajectoryPoint& node : shifted.start_from.nodes) node.time -= first_step;

  if (multipliers.size() == nodes.size()) {
    std::vector<StageMultipliers>& result = shifted.start_multipliers;
    result.push_back(first_stage(multipliers[0], multipliers[1]));
    result.insert(result.end(), multipliers.begin() + 2, multipliers.end() - 1);
    result.push_back(multipliers[multipliers.size() - 2]);
    result.push_back(multipliers.back());
  }
  return shifted;
}

}  // namespace prowl

#include "prowl/mesh/receding_horizon.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <utility>

#include "prowl/error.hpp"

namespace prowl {
namespace {

void check_nodes(const DiscreteProblem& problem, const Trajectory& motion) {
  if (problem.mesh.phases.front().intervals() < 2) {
    throw InputError("shift_horizon: the first phase has one interval; need two or more");
  }
  const bool fits = std::ranges::equal(motion.nodes, problem.nodes, {}, &TrajectoryPoint::phase, &MeshNode::phase);
  if (!fits) {
    throw InputError(
        fmt::format("shift_horizon: the motion has {} nodes, the problem's mesh {}, or their phases differ",
                    motion.nodes.size(), problem.nodes.size()));
  }
}

/// Ends of phases stay what they are; a moment inside a phase would move.
void check_terms_of_horizon(const std::vector<TermUse>& terms) {
  for (const TermUse& use : terms) {
    for (const PhaseFraction& moment : {use.from, use.to}) {
      if (moment.fraction == 0.0 || moment.fraction == 1.0) continue;
      throw InputError("horizon: term '" + use.name + "' begins or ends inside a phase; need the ends of phases");
    }
  }
}

/// Both bounds move with the duration; if the lower one is used up, the motion's remaining duration is allowed.
Duration longer(const Duration& duration, double by, double planned) {
  if (duration.is_fixed()) return {planned + by, planned + by};
  return {duration.min + by > 0.0 ? duration.min + by : std::min(duration.min, planned + by), duration.max + by};
}

/// Relative lengths of the intervals of a phase; all 1 if equal.
std::vector<double> lengths(const PhaseMesh& mesh) {
  std::vector<double> result;
  for (int i = 0; i < mesh.intervals(); ++i) {
    result.push_back(mesh.is_even() ? 1.0 : mesh.node_time(i + 1, 1.0) - mesh.node_time(i, 1.0));
  }
  return result;
}

/// Removes the first interval and adds one at the end, as long as the last. A single phase keeps its length: its first
/// interval moves to its end.
Mesh shifted(Mesh mesh) {
  std::vector<double> first = lengths(mesh.phases.front());
  if (mesh.phases.size() == 1) {
    first.push_back(first.front());
  } else {
    std::vector<double> last = lengths(mesh.phases.back());
    last.push_back(last.back());
    mesh.phases.back() = PhaseMesh(last);
  }
  first.erase(first.begin());
  mesh.phases.front() = PhaseMesh(first);
  return mesh;
}

/// Goals of the first phase move one node earlier; those at the end of the last phase stay there.
std::vector<BoundaryConstraint> shifted_constraints(const DiscreteProblem& before, const TrajectoryPoint& start,
                                                    const Mesh& mesh) {
  const MotionProblem& problem = before.problem;
  if (problem.cycle)
    throw InputError("horizon: a cycle, whose end is its start, cannot move on; need a motion with an end");
  const int last = static_cast<int>(problem.phases.size()) - 1;
  std::vector<BoundaryConstraint> constraints;
  constraints.push_back(
      BoundaryConstraint::unbounded(problem.robot, problem.start().name, problem.start().at, start.q));
  constraints.back().configuration_lower.setZero();
  constraints.back().configuration_upper.setZero();
  constraints.back().velocity_lower = constraints.back().velocity_upper = start.v;
  for (std::size_t c = 1; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& goal = problem.boundary_constraints[c];
    const int phase = goal.at.phase, node = before.nodes[before.boundary_nodes[c]].node;
    const int shifted_node = phase == 0 ? node - 1 : node;
    if (phase == 0 && shifted_node <= 0) continue;  // it is over
    constraints.push_back(goal);
    if (goal.at == PhaseFraction::end_of(last)) continue;
    constraints.back().at.fraction = mesh.phases[phase].node_time(shifted_node, 1.0);
  }
  return constraints;
}

/// The first stage has no states, so it has no multipliers for their bounds. Its other multipliers come from the second
/// stage, which is now the start.
StageMultipliers first_stage(const StageMultipliers& first, const StageMultipliers& second) {
  const auto later = [](const Eigen::VectorXd& of_first, const Eigen::VectorXd& of_second) {
    return of_first.size() == of_second.size() ? of_second : of_first;
  };
  return {later(first.next, second.next), later(first.equalities, second.equalities),
          later(first.inequalities, second.inequalities)};
}

}  // namespace

ShiftedHorizon shift_horizon(const DiscreteProblem& problem, const Trajectory& motion,
                             const std::vector<StageMultipliers>& multipliers) {
  check_nodes(problem, motion);
  check_terms_of_horizon(problem.problem.terms);
  const std::vector<TrajectoryPoint>& nodes = motion.nodes;
  const double first_step = nodes[1].time - nodes[0].time;
  const auto planned = [&](int phase) {
    const auto ends = std::ranges::equal_range(nodes, phase, {}, &TrajectoryPoint::phase);
    return std::prev(ends.end())->time - ends.begin()->time;
  };
  MotionProblem next = problem.problem;
  Mesh mesh = shifted(problem.mesh);
  const int last = static_cast<int>(next.phases.size()) - 1;
  const double last_step = last > 0 ? nodes.back().time - nodes[nodes.size() - 2].time : first_step;
  if (last > 0) {
    Duration &first_duration = next.phases.front().duration, &last_duration = next.phases.back().duration;
    first_duration = longer(first_duration, -first_step, planned(0));
    last_duration = longer(last_duration, last_step, planned(last));
  }
  next.boundary_constraints = shifted_constraints(problem, nodes[1], mesh);
  std::erase_if(next.terms, [](const TermUse& use) { return use.to == PhaseFraction::start_of(0); });  // they are over
  ShiftedHorizon result{DiscreteProblem(std::move(next), std::move(mesh)), {}, {}};

  result.warm_start.interpolation = motion.interpolation;
  result.warm_start.nodes.assign(nodes.begin() + 1, nodes.end());
  result.warm_start.nodes.push_back(nodes.back());
  result.warm_start.nodes.back().time += last_step;
  for (TrajectoryPoint& node : result.warm_start.nodes) node.time -= first_step;

  if (multipliers.size() == nodes.size()) {
    std::vector<StageMultipliers>& shifted_multipliers = result.warm_start_multipliers;
    shifted_multipliers.push_back(first_stage(multipliers[0], multipliers[1]));
    shifted_multipliers.insert(shifted_multipliers.end(), multipliers.begin() + 2, multipliers.end() - 1);
    shifted_multipliers.push_back(multipliers[multipliers.size() - 2]);
    shifted_multipliers.push_back(multipliers.back());
  }
  return result;
}

}  // namespace prowl

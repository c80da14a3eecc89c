#pragma once

#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/stagewise_nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What a receding horizon plans next, and from where: for PlanOptions::start_from and start_multipliers.
struct ShiftedHorizon {
  DiscreteProblem problem;
  Trajectory start_from;
  std::vector<StageMultipliers> start_multipliers;  ///< empty if there were none
};

/// The problem one mesh interval later. It starts at the second node of `motion`, which solves `problem` on its mesh;
/// the first phase has one interval less, the last phase one more, of the lengths that they have in the motion, and
/// goals at the end stay at the end. All else keeps its time. `start_from` is the motion without its first node,
/// standing as it ends for the new interval. `multipliers` (SolveResult::stage_multipliers, may be empty) shift with
/// their stages.
///
/// Throws InputError if the first phase has one interval only (its contacts change before the new start: another
/// problem), or if the motion has other nodes than the problem's mesh.
ShiftedHorizon shift_horizon(const DiscreteProblem& problem, const Trajectory& motion,
                             const std::vector<StageMultipliers>& multipliers);

}  // namespace prowl

#pragma once

#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/stagewise_nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Next problem of a receding horizon, with values for PlanOptions::warm_start and warm_start_multipliers.
struct ShiftedHorizon {
  DiscreteProblem problem;
  Trajectory warm_start;
  std::vector<StageMultipliers> warm_start_multipliers;  ///< empty if there were none
};

/// The problem one mesh interval later. It starts at the second node of `motion`, which solves `problem` on its mesh.
/// The first phase loses an interval, the last phase gains one, with their lengths in the motion; goals at the end stay
/// at the end. All else keeps its time. `warm_start` is the motion without its first node and with its last node
/// repeated for the new interval. `multipliers` (SolveResult::stage_multipliers, may be empty) shift with their stages.
///
/// Throws InputError if the first phase has only one interval (its contacts would change before the new start), or if
/// the motion does not fit the problem's mesh.
ShiftedHorizon shift_horizon(const DiscreteProblem& problem, const Trajectory& motion,
                             const std::vector<StageMultipliers>& multipliers);

}  // namespace prowl

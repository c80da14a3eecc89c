#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/session/plan_record.hpp"

namespace prowl {

/// Trajectory of a plan as a warm start (PlanOptions::warm_start). Throws InputError unless robot,
/// number of phases and their contacts agree; goals, durations, mesh and limits may differ.
Trajectory warm_start(const PlanRecord& record, const DiscreteProblem& asked);

}  // namespace prowl

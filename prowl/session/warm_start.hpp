#pragma once

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/session/plan_record.hpp"

namespace prowl {

/// The motion of a plan as one to start the problem from (PlanOptions::start_from). Throws InputError unless robot,
/// number of phases and their contacts are the same; goals, durations, mesh and limits may differ.
Trajectory warm_start(const PlanRecord& record, const DiscreteProblem& asked);

}  // namespace prowl

#pragma once

#include "prowl/io/plan_directory.hpp"

namespace prowl {

/// The motion of a plan as one to start the problem from (PlanOptions::start_from). Throws InputError unless robot,
/// number of phases and their contacts are the same; goals, durations, mesh and limits may differ.
Trajectory warm_start(const PlanRecord& record, const DiscreteProblem& asked);

}  // namespace prowl

#pragma once

#include <string>

#include "prowl/io/plan_directory.hpp"

namespace prowl {

/// "HyQ crouch: converged after 23 iterations ...", mesh and size, in a few lines.
std::string plan_summary(const PlanRecord& record);

/// Verdict, grade and a table of all checks: worst value, limit, time and place.
std::string certificate_summary(const Certificate& certificate);

/// The mesh at which the local integration error would reach "certified", judged from this one, as it falls with h³; ""
/// if it is there already or cannot be judged.
std::string mesh_advice(const PlanRecord& record);

}  // namespace prowl

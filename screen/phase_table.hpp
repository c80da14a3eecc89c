#pragma once

#include <string>

#include "prowl/mesh/discrete_problem.hpp"

namespace prowl {

/// The phases of a motion, one a line: duration, mesh intervals and, for every contact of the robot, the surface that
/// it holds, and whether it lands at the phase's first node or opens at its last.
std::string phase_table(const DiscreteProblem& discrete);
/// The same as JSON, with the places that the task prescribes.
std::string phases_json(const DiscreteProblem& discrete);

}  // namespace prowl

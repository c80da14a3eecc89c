#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// What a problem says that is possible, yet seldom meant, each a line in the words of the task: a robot in other units
/// than metres and kilograms, friction that no sole has, mesh intervals in which a robot could fall over. A problem
/// with such numbers is solved like any other.
std::vector<std::string> implausibilities(const MotionProblem& problem, const Mesh& mesh);

}  // namespace prowl

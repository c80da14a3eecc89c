#pragma once

#include <string>
#include <vector>

#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Possible but unlikely numbers of a problem, one line each in the words of the task: a robot in other units than
/// metres and kilograms, friction beyond any sole, mesh intervals in which a robot could fall over, an end at rest
/// above one or two points. They do not stop a solve.
std::vector<std::string> implausibilities(const MotionProblem& problem, const Mesh& mesh);

}  // namespace prowl

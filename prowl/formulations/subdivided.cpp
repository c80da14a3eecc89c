#include "prowl/formulations/subdivided.hpp"

namespace prowl {

MotionProblem subdivided(MotionProblem problem, int parts) {
  for (Phase& phase : problem.phases) phase.intervals *= parts;
  for (BoundaryCondition& condition : problem.boundary_conditions) condition.at.node *= parts;
  return problem;
}

}  // namespace prowl

#pragma once

#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// One phase of a motion on its own grid of equal steps, both ends included.
struct ReferencePhase {
  std::string name;
  std::vector<int> contacts;             ///< indices of the robot, in stance throughout
  std::vector<TrajectoryPoint> samples;  ///< two or more

  double start() const { return samples.front().time; }
  double end() const { return samples.back().time; }
  double step() const { return (end() - start()) / static_cast<double>(samples.size() - 1); }
};

/// Samples the phases of a motion with its own interpolation, in equal steps of at most `step` > 0
/// [s]. The last sample of a phase and the first of the next have the same time. Throws InputError
/// for a phase of zero duration.
std::vector<ReferencePhase> reference_grid(const MotionProblem& problem, const Trajectory& trajectory, double step);

}  // namespace prowl

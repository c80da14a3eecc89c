#pragma once

#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// One phase of a motion on a grid of its own: equal steps of at most so long, both ends included.
struct ReferencePhase {
  std::string name;
  std::vector<int> contacts;             ///< of the robot, held throughout
  std::vector<TrajectoryPoint> samples;  ///< two or more

  double start() const { return samples.front().time; }
  double end() const { return samples.back().time; }
  double step() const { return (end() - start()) / static_cast<double>(samples.size() - 1); }
};

/// The phases of a motion, interpolated as it was transcribed. At a switch of contacts, the last sample of a phase and
/// the first of the next are at one time. `step` > 0 [s]. Throws InputError where a phase has no duration.
std::vector<ReferencePhase> reference_grid(const MotionProblem& problem, const Trajectory& trajectory, double step);

}  // namespace prowl

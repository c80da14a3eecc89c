#pragma once

#include <string>
#include <vector>

#include "prowl/files/text_file.hpp"
#include "prowl/mesh/mesh.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Names of the columns, with units (docs/plan-directory.md).
std::vector<std::string> trajectory_columns(const RobotModel& robot);

/// One line per point, numbers with all digits: reading them gives the same doubles.
std::string trajectory_to_csv(const MotionProblem& problem, const Trajectory& trajectory);

/// Largest file for trajectory_from_csv [bytes]: no trajectory on the mesh is longer.
std::size_t longest_trajectory(const MotionProblem& problem, const Mesh& mesh);

/// Throws InputError "file:line: column: ..." unless the columns are those of the robot, the rows those of the mesh
/// with the contacts of the problem, all numbers finite, and the last line complete.
Trajectory trajectory_from_csv(const MotionProblem& problem, const Mesh& mesh, const SourceText& source);

/// Most samples of a motion with a uniform step: some gigabytes of text.
constexpr double kMostUniformSamples = 1e7;

/// Points at 0, step, 2 step, ... and the end; at a phase transition the point of the later phase.
Trajectory sample_uniformly(const Trajectory& trajectory, double step);

}  // namespace prowl

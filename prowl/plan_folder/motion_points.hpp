#pragma once

#include <vector>

#include "prowl/files/csv_table.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Points of a motion, no more than `step` [s] apart, the nodes among them: of each mesh interval its first node, equal
/// parts, its last. A phase switch has two points at one time.
std::vector<TrajectoryPoint> report_points(const Trajectory& trajectory, double step);

/// What simulate.csv tells of the true motion, rows no less than `step` [s] apart: time, q, v, tau and measured contact
/// forces; the rest of a point is empty. Ends before the first row that is not finite. Throws InputError.
std::vector<TrajectoryPoint> simulated_points(const RobotModel& robot, const CsvTable& simulation, double step);

/// A step that leaves about as many points as a report can hold.
double report_step(double duration);

}  // namespace prowl

#pragma once

#include <vector>

#include "prowl/files/csv_table.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Points of a motion at most `step` [s] apart: all nodes, and equal parts of each mesh interval. A phase transition
/// has two points at one time.
std::vector<TrajectoryPoint> report_points(const Trajectory& trajectory, double step);

/// The true motion in simulate.csv, rows at least `step` [s] apart: time, q, v, tau and measured contact forces; other
/// members are empty. Ends before the first row that is not finite. Throws InputError.
std::vector<TrajectoryPoint> simulated_points(const RobotModel& robot, const CsvTable& simulation, double step);

/// A step [s] that gives as many points as a report can hold.
double report_step(double duration);

}  // namespace prowl

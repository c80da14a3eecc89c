#pragma once

#include "prowl/online/online_run.hpp"

namespace prowl {

/// Time at which commands of runs begin [s].
inline constexpr double kFirstCommand = 1.0;

/// Adds a kick every 2 s, until 1.9 s before the end: a horizontal push of 0.1 s in a random direction whose impulse is
/// the mass of the robot times `speed` [m/s]. The seed is that of the simulation.
void add_kicks(const RobotModel& robot, double speed, OnlineOptions& options);

/// Adds one such kick at a random time from 2 to 4 s.
void add_one_kick(const RobotModel& robot, double speed, OnlineOptions& options);

/// Adds a random command every 1 to 4 s from 1 s on, until 3 s before the end: velocities within `most` [m/s], turn
/// rates within `most` [rad/s], uniformly.
void add_random_commands(double most, OnlineOptions& options);

}  // namespace prowl

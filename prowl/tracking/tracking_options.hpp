#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Default deviations that cost 1 per second each; origin: docs/tracking.md.
struct DefaultDeviations {
  double base_position = 0.02;         ///< [m]
  double base_orientation = 0.04;      ///< [rad]
  double joint_position = 0.1;         ///< [rad]
  double base_linear_velocity = 0.2;   ///< [m/s]
  double base_angular_velocity = 0.4;  ///< [rad/s]
  double joint_velocity = 10.0;        ///< [rad/s]
  double torque_share = 0.1;           ///< of the torque limit [-]
  double swing_foot = 0.02;            ///< each axis [m]
};

/// Weights of the gains as deviations, each of which costs 1 per second (Bryson and Ho, Applied
/// Optimal Control, 1975, section 5.2). This makes metres, radians and newton metres comparable.
///
///   cost = integral of  sum_i (dx_i / state_deviation_i)² + sum_j (dtau_j / torque_deviation_j)²  over time
struct TrackingOptions {
  double step = 2e-3;                ///< largest step of the grid of gains [s]
  Eigen::VectorXd state_deviation;   ///< 2 nv, > 0: tangent of configuration.hpp [m, rad], v [m/s, rad/s]
  Eigen::VectorXd torque_deviation;  ///< nu, > 0 [N m]
  /// Of a foot that will land, besides its joints, each axis [m]: the base may not swing it aside to keep its balance.
  double swing_foot_deviation = DefaultDeviations{}.swing_foot;
  /// A foot that lands beside its foothold stays there. The deviation removed by a landing costs as
  /// if it lasted this long [s].
  double landing_time = 1.0;
  /// A deviation from a goal of the configuration before the end costs, besides, as if it lasted this long at its
  /// moment [s]. Of 0.3, 1, 3, 5 and 10 s, 3 s let most of HyQ's rears meet their goal: with less the pitch misses it,
  /// with more it falls.
  double goal_time = 3.0;
  /// Largest crossover frequency of the loop gain from torque to torque [rad/s]. Faster gains are
  /// scaled down to it, in their directions of torque only: delays and filters of a robot cost
  /// phase, 0.3 rad for 3 ms at this value.
  double largest_bandwidth = 100.0;

  Eigen::VectorXd state_weight() const { return state_deviation.array().square().inverse(); }    ///< 2 nv
  Eigen::VectorXd torque_weight() const { return torque_deviation.array().square().inverse(); }  ///< nu
};

/// The default deviations for this robot.
TrackingOptions default_tracking_options(const RobotModel& robot);

}  // namespace prowl

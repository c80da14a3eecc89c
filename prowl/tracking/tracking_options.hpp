#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Deviations that cost 1 a second each unless said otherwise: docs/tracking.md says where they come from.
struct DefaultDeviations {
  double base_position = 0.02;         ///< [m]
  double base_orientation = 0.04;      ///< [rad]
  double joint_position = 0.1;         ///< [rad]
  double base_linear_velocity = 0.2;   ///< [m/s]
  double base_angular_velocity = 0.4;  ///< [rad/s]
  double joint_velocity = 10.0;        ///< [rad/s]
  double torque_share = 0.1;           ///< of the torque limit [-]
};

/// What the gains weigh, as deviations: each costs 1 a second where it is as large as its number here (Bryson and Ho,
/// Applied Optimal Control, 1975, section 5.2), so that metres, radians and newton metres can be compared.
///
///   cost = integral of  sum_i (dx_i / state_deviation_i)² + sum_j (dtau_j / torque_deviation_j)²  over time
struct TrackingOptions {
  double step = 2e-3;                ///< largest step of the grid of gains [s]
  Eigen::VectorXd state_deviation;   ///< 2 nv, > 0: tangent of configuration.hpp [m, rad], v [m/s, rad/s]
  Eigen::VectorXd torque_deviation;  ///< nu, > 0 [N m]
  /// A foot that lands beside its place stays there. What a landing cuts off the state costs as if it stayed so long
  /// [s].
  double landing_time = 1.0;
  /// Bandwidth of the feedback [rad/s]: frequency where the loop gain from torque to torque is one. Gains that would go
  /// beyond it are scaled down to it, in the directions of torque where they do: delays and filters of a robot cost
  /// phase, 0.3 rad at 3 ms and this.
  double largest_bandwidth = 100.0;

  Eigen::VectorXd state_weight() const { return state_deviation.array().square().inverse(); }    ///< 2 nv
  Eigen::VectorXd torque_weight() const { return torque_deviation.array().square().inverse(); }  ///< nu
};

/// The default deviations for this robot.
TrackingOptions default_tracking_options(const RobotModel& robot);

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// One instant of a motion. q, v, a, tau as in RobotModel; a is the rate of v (components in the base frame).
struct TrajectoryPoint {
  double time = 0.0;  ///< [s]
  int phase = 0;
  Eigen::VectorXd q, v, a, tau;
  Eigen::VectorXd force;  ///< 3 per contact of the ROBOT (robot order), world frame [N]; zero where not in contact
};

/// How a motion runs between two nodes.
enum class Interpolation {
  trapezoid,  ///< interpolate(), below
  hermite,    ///< cubics through position and velocity, velocity and acceleration: hermite_interval.hpp
};

/// A motion at the nodes of its mesh: the nodes of each phase in order, so a phase switch has two at one time.
struct Trajectory {
  std::vector<TrajectoryPoint> nodes;
  Interpolation interpolation = Interpolation::trapezoid;
  /// Of hermite: torque in the middle of each mesh interval [N m], with which it is quadratic; empty: linear.
  std::vector<Eigen::VectorXd> middle_torques = {};

  bool empty() const { return nodes.empty(); }
  double duration() const { return nodes.empty() ? 0.0 : nodes.back().time; }
};

/// The motion inside the interval from `left` to `right` (one phase, right.time > left.time), at time
/// left.time + s, 0 <= s <= h, as the trapezoid means it:
///   a, tau, f and the base's world velocity are linear in s; v, joints and base position quadratic;
///   R(s) = R_k exp((s - s^2/2h) w_k) exp((s^2/2h) w_{k+1}).
/// At s = h it meets `right` up to the defects that the solver left.
TrajectoryPoint interpolate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s);

/// Rate of the interpolated configuration at s, in the tangent of configuration.hpp: velocity of the base in the world,
/// angular velocity in the base frame, joint rates. It meets v at the nodes and is off by O(h^2) between them.
Eigen::VectorXd interpolated_rate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s);

/// v as such a rate: with its base velocity turned into the world.
Eigen::VectorXd tangent_rate(const TrajectoryPoint& point);

/// The motion at time t in [0, duration], as its interpolation has it; at a phase switch, the point of the later phase.
TrajectoryPoint sample(const Trajectory& trajectory, double t);

}  // namespace prowl

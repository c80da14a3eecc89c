#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// One instant of a motion. q, v, a, tau as in RobotModel; a: rate of the components of v (base
/// frame).
struct TrajectoryPoint {
  double time = 0.0;  ///< [s]
  int phase = 0;
  Eigen::VectorXd q, v, a, tau;
  Eigen::VectorXd force;  ///< 3 per contact of the ROBOT (robot order), world frame [N]; zero without contact
};

/// Interpolation between two nodes.
enum class Interpolation {
  trapezoid,  ///< interpolate(), below
  hermite,    ///< cubics, see hermite_interval.hpp
};

const char* to_string(Interpolation interpolation);

/// A motion at the nodes of its mesh, phase by phase: a phase transition has two nodes at one time.
struct Trajectory {
  std::vector<TrajectoryPoint> nodes;
  Interpolation interpolation = Interpolation::trapezoid;
  /// With `hermite`: torque (nu) in the middle of each mesh interval for quadratic torques [N m];
  /// empty: linear.
  std::vector<Eigen::VectorXd> middle_torques = {};

  bool empty() const { return nodes.empty(); }
  double duration() const { return nodes.empty() ? 0.0 : nodes.back().time; }
};

/// The motion inside the interval from `left` to `right` (one phase, right.time > left.time), at
/// time left.time + s, 0 <= s <= h, consistent with the trapezoid:
///   a, tau, f and the base's world velocity are linear in s; v, joints and base position quadratic;
///   R(s) = R_k exp((s - s^2/2h) w_k) exp((s^2/2h) w_{k+1}).
/// At s = h it equals `right` up to the remaining defects.
TrajectoryPoint interpolate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s);

/// Rate (nv) of the interpolated configuration at s, in the tangent of configuration.hpp: base
/// velocity in the world, angular velocity in the base frame, joint rates. Equals v at the nodes,
/// within O(h^2) between them.
Eigen::VectorXd interpolated_rate(const TrajectoryPoint& left, const TrajectoryPoint& right, double s);

/// v as such a rate: base velocity in world axes.
Eigen::VectorXd tangent_rate(const TrajectoryPoint& point);

/// Interpolated motion at time t in [0, duration]; at a phase transition, the point of the later
/// phase.
TrajectoryPoint sample(const Trajectory& trajectory, double t);

}  // namespace prowl

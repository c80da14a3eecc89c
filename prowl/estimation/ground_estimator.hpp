#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/estimation/state_estimator.hpp"
#include "prowl/model/leg_kinematics.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Where the ground is, beside where the plan has it: all surfaces moved as one rigid body, a point p by
///
///   d(p) = h z + w x (p - pivot),   w horizontal
///
/// A Kalman filter of (h, w_x, w_y) takes the standing feet of the estimated state, along the normals of their
/// surfaces. A foot that has just landed does not count: it may be late. docs/simulation.md#what-runs-on-board.
class GroundEstimator {
 public:
  /// `q_start` (nq): planned, in which `stand` holds. `footed`: contacts that are in stance at any time of the plan,
  /// one flag per contact of the robot; the others keep their planned path.
  GroundEstimator(const RobotModel& robot, const Eigen::VectorXd& q_start, const Stand& stand,
                  std::vector<bool> footed);

  /// Contacts begin to land this long before they do [s].
  static constexpr double kLead = 0.03;

  /// Advances by dt [s] to the estimated state q (nq) at a time with the planned state q_planned (nq); `soon`: what
  /// stands kLead later.
  void update(double dt, const Eigen::VectorXd& q, const Eigen::VectorXd& q_planned, const Stand& stand,
              const Stand& soon);

  double height() const { return state_(0); }                    ///< h, at the pivot [m]
  Eigen::Vector2d tilt() const { return state_.tail<2>(); }      ///< w_x, w_y, world frame [rad]
  Eigen::Vector3d displacement(const Eigen::Vector3d& p) const;  ///< d(p), world frame [m]

  /// Step (nv) from q_planned (nq) that lays the plan on the ground: the base stays, the footed contacts move with the
  /// ground. Those that land aim a little below it.
  Eigen::VectorXd correction(const Eigen::VectorXd& q_planned);

 private:
  LegKinematics legs_;
  std::vector<bool> footed_;
  std::vector<double> since_;  ///< time in stance of each contact, negative in the air [s]
  std::vector<Eigen::Vector3d> planned_;
  std::vector<double> press_;  ///< of each contact, 0 to 1
  std::vector<Eigen::Vector3d> normals_;
  double size_;  ///< standing height [m]
  Eigen::Vector3d pivot_;
  Eigen::Vector3d state_ = Eigen::Vector3d::Zero();  ///< (h, w_x, w_y)
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
};

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Forward dynamics with contact points held fixed, by Pinocchio's `constraintDynamics`: the second opinion of the
/// certificate, which shares no code with prowl/dynamics. It solves
///
///   M a + h = S' tau + J' f,    J a + Jdot v = 0
///
/// by a proximal method, so J may be rank deficient; then f is the one of least norm. No Baumgarte stabilisation.
/// One oracle, one thread.
class ConstrainedDynamicsOracle {
 public:
  /// `contacts`: indices into robot.contacts() that are held fixed. Keeps a reference to `robot`.
  ConstrainedDynamicsOracle(const RobotModel& robot, const std::vector<int>& contacts);
  ConstrainedDynamicsOracle(ConstrainedDynamicsOracle&&) noexcept;
  ~ConstrainedDynamicsOracle();

  struct Motion {
    Eigen::VectorXd a;      ///< nv, rate of v
    Eigen::VectorXd force;  ///< 3 per contact of the robot, world frame [N]; zero where not held
    double residual = 0.0;  ///< largest entry of |J a + Jdot v| [m/s^2]; not small: the contacts contradict each other
  };
  Motion evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau);

  struct ContactPoints {
    Eigen::Matrix3Xd position;  ///< of every contact of the robot, world frame [m]
    Eigen::Matrix3Xd velocity;  ///< world frame [m/s]
  };
  ContactPoints contact_points(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

 private:
  struct Workspace;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace prowl

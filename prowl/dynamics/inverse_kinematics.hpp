#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Target of a contact point.
struct ContactTarget {
  int contact = 0;           ///< index into RobotModel::contacts()
  Eigen::Vector3d position;  ///< of the contact point (its offset included), world frame [m]
};

struct InverseKinematics {
  Eigen::VectorXd q;       ///< nq; joints within their limits, base as given
  double residual = 0.0;   ///< largest distance of a contact from its target [m]
  bool converged = false;  ///< residual <= kTolerance; if not, q is the nearest posture found

  static constexpr double kTolerance = 1e-8;  ///< [m]; near a solution one more step squares the error
};

/// Joint positions that put contact points at their targets, the base held at its pose in q_guess:
///
///   minimise 1/2 sum_c |p_c(q) - target_c|^2  over the joints,  lower <= joints <= upper
///
/// Levenberg-Marquardt with an active set of limits, from the joints of q_guess: it finds a nearby posture (the knee
/// keeps its side) and does not move joints without effect on a target. The method is local: not converged means
/// "not found from here"; for legs of a quadruped near standing, "out of reach".
InverseKinematics inverse_kinematics(const RobotModel& robot, const Eigen::VectorXd& q_guess,
                                     const std::vector<ContactTarget>& targets);

}  // namespace prowl

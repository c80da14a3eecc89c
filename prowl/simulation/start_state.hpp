#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/simulation/physics.hpp"

namespace prowl {

/// Error of the state in which a simulation starts, which the estimator does not know. Empty: none.
struct StartError {
  Eigen::Matrix<double, 6, 1> base = Eigen::Matrix<double, 6, 1>::Zero();   ///< world frame [m], rotation vector [rad]
  Eigen::Matrix<double, 6, 1> twist = Eigen::Matrix<double, 6, 1>::Zero();  ///< base frame [m/s, rad/s]
  Eigen::VectorXd joints = {};                                              ///< nu [rad]; empty: 0
  bool is_none() const { return base.isZero(0.0) && twist.isZero(0.0) && joints.isZero(0.0); }
};

/// The state (q, v) with that error. Joints follow where contacts hold: these keep their places along the surfaces of
/// `ground`, touch them and are still. `holds[c]`: index of the surface on which contact c stands, or -1.
void displace(Physics& physics, const std::vector<Surface>& ground, const std::vector<int>& holds,
              const StartError& error, Eigen::VectorXd& q, Eigen::VectorXd& v);

}  // namespace prowl

#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {

struct StartState {
  Eigen::VectorXd q, v;  ///< nq, nv
};

/// Start state with the base displaced and the feet in place: joints by inverse kinematics,
/// velocity of the reference projected on what the contacts allow. `displacement`: of the base,
/// world frame [m], and a rotation vector, base frame [rad]. Throws InputError if it is not finite
/// or out of reach of the legs.
StartState displaced_start(const RobotModel& robot, const Tracker& tracker,
                           const Eigen::Matrix<double, 6, 1>& displacement);

}  // namespace prowl

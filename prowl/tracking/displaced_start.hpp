#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {

struct StartState {
  Eigen::VectorXd q, v;  ///< nq, nv
};

/// How the robot of a tracking plan stands at its start if the base is elsewhere and the feet are in place: the base of
/// the reference moved, the joints by inverse kinematics, the velocity of the reference but for what the contacts
/// forbid there. `displacement`: of the base in the world frame [m], and a rotation vector in the base frame [rad].
/// Throws InputError if it is not finite or the legs do not reach so far.
StartState displaced_start(const RobotModel& robot, const Tracker& tracker,
                           const Eigen::Matrix<double, 6, 1>& displacement);

}  // namespace prowl

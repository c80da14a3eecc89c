#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// The torques nearest to tau that hold the robot at rest at q on these contacts: tau + d with the least |d| whose projected
/// dynamics have no acceleration at v = 0. A motion may come to rest with an acceleration left; what goes on holding its last
/// torques would push the robot off. Throws NumericalError if no torques hold it there.
Eigen::VectorXd rest_torque(const RobotModel& robot, const std::vector<int>& contacts, const Eigen::VectorXd& q,
                            const Eigen::VectorXd& tau);

}  // namespace prowl

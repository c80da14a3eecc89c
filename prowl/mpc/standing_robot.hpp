#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Contacts of each foot: those on one body of the robot, in the order of RobotModel::contacts().
std::vector<std::vector<int>> contacts_of_feet(const RobotModel& robot);

/// The nominal posture with all contacts on the ground z = 0 (nq). Throws InputError if they do not reach it.
Eigen::VectorXd standing_on_ground(const RobotModel& robot);

}  // namespace prowl

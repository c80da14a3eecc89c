#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/mpc_plan.hpp"

namespace prowl {

/// Contacts of each foot: those on one body of the robot, in the order of RobotModel::contacts().
std::vector<std::vector<int>> contacts_of_feet(const RobotModel& robot);

/// Contacts of the feet that stand, in the order of RobotModel::contacts(). Bit f: foot f stands.
std::vector<int> standing_contacts(const std::vector<std::vector<int>>& feet, unsigned standing);

/// The nominal posture with all contacts on the ground z = 0 (nq). Throws InputError if they do not reach it.
Eigen::VectorXd standing_on_ground(const RobotModel& robot);

/// A step of a plan that stands still at q, without times or gains.
MpcPlan::Step standing_step(const RobotModel& robot, const std::vector<std::vector<int>>& feet,
                            const Eigen::VectorXd& q);

}  // namespace prowl

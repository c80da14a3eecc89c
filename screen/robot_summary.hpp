#pragma once

#include <string>

#include "prowl/model/robot_inspection.hpp"

namespace prowl {

/// What was understood of a robot: joints in order with limits, mass, contacts, rank of the contact Jacobian, warnings.
std::string robot_summary(const RobotModel& robot, const RobotInspection& inspection);
/// The frames that a contact may be fixed to, one a line.
std::string frame_list(const RobotModel& robot);
/// All of this as JSON; null where there is no limit.
std::string robot_report_json(const RobotModel& robot, const RobotInspection& inspection);

}  // namespace prowl

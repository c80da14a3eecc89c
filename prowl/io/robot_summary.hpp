#pragma once

#include <string>

#include "prowl/model/robot_inspection.hpp"

namespace prowl {

/// What was understood of a robot: joints in order with limits, mass, contacts, rank of the contact Jacobian, warnings.
std::string robot_summary(const RobotModel& robot, const RobotInspection& inspection);
/// The same as JSON; null where there is no limit.
std::string robot_report_json(const RobotModel& robot, const RobotInspection& inspection);

}  // namespace prowl

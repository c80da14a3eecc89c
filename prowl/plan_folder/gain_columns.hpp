#pragma once

#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Names, with units, of the 2 nv columns of a gain K: what a torque answers to (prowl/tracker/tracker.hpp).
std::vector<std::string> gain_columns(const RobotModel& robot);

}  // namespace prowl

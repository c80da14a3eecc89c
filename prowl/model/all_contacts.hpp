#pragma once

#include <numeric>
#include <vector>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Indices of all contacts of a robot, in their order.
inline std::vector<int> all_contacts(const RobotModel& robot) {
  std::vector<int> contacts(robot.contacts().size());
  std::iota(contacts.begin(), contacts.end(), 0);
  return contacts;
}

}  // namespace prowl

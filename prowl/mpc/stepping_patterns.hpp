#pragma once

#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/contact_timeline.hpp"

namespace prowl {

/// stand, trot, walk, pace.
const std::vector<std::string>& stepping_gaits();

/// The pattern of a gait for these feet (contacts of each, contacts_of_feet()). Durations follow from the standing
/// height [m]. Throws InputError for an unknown name, or a gait that the robot's feet do not allow.
SteppingPattern stepping_pattern(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double height,
                                 const std::string& gait);

}  // namespace prowl

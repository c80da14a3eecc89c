#pragma once

#include <string>
#include <vector>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

/// Names of the joints behind the base, in their order.
std::vector<std::string> moving_joints(const pinocchio::Model& model);

/// True if `joint` is in `locked_joints` of the description.
bool is_locked(const RobotDescription& description, const std::string& joint);

/// Makes locked joints, and those that copy others, fixed ones at their nominal positions; adds the latter to
/// `locked_joints` of the description. Throws DescriptionError for a name that is not a moving joint.
void lock_joints(RobotDescription& description, PinocchioModel& pin);

/// Joints whose motion, alone or with others, moves no mass with all joints at 0; of several, the last of their chain.
std::vector<std::string> find_massless_joints(const pinocchio::Model& model);

}  // namespace prowl

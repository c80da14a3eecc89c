#pragma once

#include <string>

#include "prowl/model/robot_model.hpp"
#include "prowl/plan_folder/robot_look.hpp"

namespace prowl {

/// The MJCF text `model` of mujoco_xml() with geoms that show the robot: of class "visual", in group 2, without mass or
/// collisions. Their meshes are in the text itself, with six digits; parts too small to see are left out.
std::string add_mujoco_visuals(const std::string& model, const RobotModel& robot, const RobotLook& look);

}  // namespace prowl

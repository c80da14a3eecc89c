#pragma once

// Heavy (seconds of compile time): include it only from .cpp files of model, dynamics and the certificate.
#include <pinocchio/multibody.hpp>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/urdf_check.hpp"

namespace prowl {

inline constexpr pinocchio::JointIndex kBaseJoint = 1;  ///< 0 is the world

struct PinocchioModel {
  pinocchio::Model model;
  std::vector<pinocchio::FrameIndex> contact_frames;  ///< one per contact of the robot, same order; origin = its point
  UrdfFacts urdf;  ///< its links are those before fixed joints merge them into bodies
};

}  // namespace prowl

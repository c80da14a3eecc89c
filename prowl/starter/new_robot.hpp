#pragma once

#include <string>
#include <vector>

#include "prowl/model/robot_description.hpp"
#include "prowl/model/urdf/package_path.hpp"
#include "prowl/starter/foot_contacts.hpp"
#include "prowl/starter/legs.hpp"
#include "prowl/starter/limit_guesses.hpp"
#include "prowl/starter/standing_posture.hpp"

namespace prowl {

/// A robot description made from a URDF alone, with the origin of each part.
struct NewRobot {
  RobotDescription description;  ///< with contacts, posture and limits; its name is the URDF's without "_description"
  double mass = 0.0;             ///< [kg]
  LegSearch search;
  std::vector<FootContacts> feet;  ///< one per leg
  StandingPosture posture;
  std::vector<LimitGuess> limits;
  double torque_share = 0.0;  ///< largest joint torque for standing, as a share of the limit
  std::string torque_joint;   ///< its joint
  std::vector<std::string> missing_meshes;
};

/// Completes a description that has `urdf`, absolute, `urdf_text` and perhaps `armature`. Throws InputError if the URDF
/// is unsuitable, or describes a robot without legs.
NewRobot new_robot(RobotDescription description, const PackageSearch& search);

}  // namespace prowl

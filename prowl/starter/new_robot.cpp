#include "prowl/starter/new_robot.hpp"

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/model/urdf/urdf_outline.hpp"
#include "prowl/starter/robot_pose.hpp"
#include "prowl/text/name_check.hpp"

namespace prowl {
namespace {

/// Contacts of all feet in one pose; sets contacts_of_leg to their indices by leg.
std::vector<ContactPoint> find_feet(const RobotPose& pose, const std::vector<Leg>& legs,
                                    const std::vector<FootShapes>& shapes, std::vector<FootContacts>& feet,
                                    std::vector<std::vector<int>>& contacts_of_leg) {
  feet.clear();
  contacts_of_leg.clear();
  std::vector<ContactPoint> contacts;
  for (std::size_t l = 0; l < legs.size(); ++l) {
    feet.push_back(foot_contacts(pose, legs[l], shapes[l]));
    std::vector<int>& indices = contacts_of_leg.emplace_back();
    for (const ContactPoint& contact : feet.back().contacts) {
      indices.push_back(static_cast<int>(contacts.size()));
      contacts.push_back(contact);
    }
  }
  return contacts;
}

void set_joints(const RobotModel& robot, const Eigen::VectorXd& joints, RobotDescription& description) {
  for (Eigen::Index j = 0; j < robot.nu(); ++j) {
    description.nominal_joints[robot.joint_names()[j]] = joints(j);
  }
}

void set_limits(const std::vector<LimitGuess>& guesses, RobotDescription& description) {
  description.limits.clear();
  for (const LimitGuess& guess : guesses) {
    JointLimits limits;
    if (guess.position) {
      limits.position_lower = guess.position->first;
      limits.position_upper = guess.position->second;
    }
    limits.velocity = guess.velocity;
    limits.torque = guess.torque;
    if (limits.position_lower || limits.velocity || limits.torque) description.limits[guess.joint] = limits;
  }
}

/// Name of the URDF or of its file, without "_description".
std::string robot_name(const std::string& outline_name, const std::filesystem::path& urdf) {
  std::string name = is_name(outline_name) ? outline_name : is_name(urdf.stem().string()) ? urdf.stem().string() : "";
  constexpr std::string_view kPackage = "_description";
  if (name.ends_with(kPackage)) name.erase(name.size() - kPackage.size());
  return name.empty() ? "robot" : name;
}

}  // namespace

NewRobot new_robot(RobotDescription given, const PackageSearch& search) {
  NewRobot result;
  RobotDescription& description = result.description;
  description = std::move(given);
  UrdfOutline outline = urdf_outline(description.urdf.string(), description.urdf_text);
  description.name = robot_name(outline.name, description.urdf);
  description.locked_joints = massless_joints(description);
  for (const std::string& joint : description.locked_joints) {
    std::erase_if(outline.joints, [&](const UrdfOutline::Limits& limits) { return limits.joint == joint; });
  }
  description.limits = usable_limits(outline);

  const RobotModel bare(description);
  result.mass = bare.mass();
  result.search = find_legs(bare);
  description.nominal_base_rpy = result.search.base_rpy;
  std::vector<int> bodies;
  for (const Leg& leg : result.search.legs) bodies.push_back(leg.foot);
  const std::vector<FootShapes> shapes = foot_shapes(bare, bodies, search);
  for (const FootShapes& foot : shapes) {
    for (const std::string& mesh : foot.missing) {
      if (std::find(result.missing_meshes.begin(), result.missing_meshes.end(), mesh) == result.missing_meshes.end()) {
        result.missing_meshes.push_back(mesh);
      }
    }
  }

  // The touching points depend on the posture: first with joints near 0, then in the posture found
  // with these.
  RobotPose pose(bare, result.search.upright);
  pose.set(neutral_joints(bare));
  std::vector<std::vector<int>> contacts_of_leg;
  for (int pass = 0; pass < 2; ++pass) {
    description.contacts = find_feet(pose, result.search.legs, shapes, result.feet, contacts_of_leg);
    result.posture = standing_posture(RobotModel(description), result.search, contacts_of_leg);
    pose.set(result.posture.joints);
  }
  set_joints(bare, result.posture.joints, description);

  std::vector<int> all;
  for (std::size_t c = 0; c < description.contacts.size(); ++c) all.push_back(static_cast<int>(c));
  const RobotModel standing(description);
  const Eigen::VectorXd torque = static_equilibrium(standing, standing.nominal_configuration(), all).tau;
  result.limits = guess_limits(standing, outline, result.search.legs, result.posture, torque);
  set_limits(result.limits, description);

  const RobotModel complete(description);
  for (int j = 0; j < complete.nu(); ++j) {
    const double share = std::abs(torque(j)) / complete.torque_limit()(j);
    if (share <= result.torque_share) continue;
    result.torque_share = share;
    result.torque_joint = complete.joint_names()[j];
  }
  return result;
}

}  // namespace prowl

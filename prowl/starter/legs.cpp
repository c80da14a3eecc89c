#include "prowl/starter/legs.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "prowl/error.hpp"
#include "prowl/starter/robot_pose.hpp"

namespace prowl {
namespace {

constexpr double kSameLevel = 0.25;  // of the height of the base above the lowest end
constexpr double kHangs = 0.5;       // of the largest reach; a limb with less is an arm to the side
constexpr double kBelow =
    0.8;  // of the height: legs stand around the base, not beside it; bent legs may all reach back

struct Limb {
  std::vector<int> joints;
  int end = 0;             // body
  Eigen::Vector3d lowest;  // lowest frame, axes of the search [m]
};

std::vector<Limb> find_limbs(const BodyTree& tree) {
  std::vector<bool> is_leaf(tree.bodies.size(), true);
  for (const RigidBody& body : tree.bodies) {
    if (body.parent >= 0) is_leaf[body.parent] = false;
  }
  std::vector<Limb> limbs;
  for (std::size_t b = 1; b < tree.bodies.size(); ++b) {
    if (!is_leaf[b]) continue;
    Limb& limb = limbs.emplace_back();
    limb.end = static_cast<int>(b);
    for (int body = limb.end; body > 0; body = tree.bodies[body].parent) {
      limb.joints.insert(limb.joints.begin(), body - 1);
    }
  }
  return limbs;
}

void find_lowest_points(const RobotPose& pose, std::vector<Limb>& limbs) {
  for (Limb& limb : limbs) {
    limb.lowest = pose.body(limb.end).translation();
    for (const RobotLink& link : pose.links()) {
      if (link.body != limb.end) continue;
      const Eigen::Vector3d origin = pose.point(link.body, link.placement.translation());
      if (origin.z() < limb.lowest.z()) limb.lowest = origin;
    }
  }
}

/// Limbs that stand on the ground with z of the pose up; empty if none hang down.
std::vector<Limb> standing_limbs(std::vector<Limb> limbs, const RobotPose& pose) {
  find_lowest_points(pose, limbs);
  double lowest = 0.0, furthest = 0.0;
  for (const Limb& limb : limbs) {
    lowest = std::min(lowest, limb.lowest.z());
    furthest = std::max(furthest, limb.lowest.norm());
  }
  const double height = -lowest;
  if (height < kHangs * furthest) return {};
  std::erase_if(limbs, [&](const Limb& limb) { return limb.lowest.z() > lowest + kSameLevel * height; });
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (const Limb& limb : limbs) mean += limb.lowest / static_cast<double>(limbs.size());
  if (limbs.size() < 2 || mean.head<2>().norm() > kBelow * height) return {};
  return limbs;
}

/// Drops joints common to several legs: a waist above both moves neither against the other.
std::vector<Leg> to_legs(const std::vector<Limb>& limbs) {
  std::map<int, int> uses;
  for (const Limb& limb : limbs) {
    for (const int joint : limb.joints) ++uses[joint];
  }
  std::vector<Leg> legs;
  for (const Limb& limb : limbs) {
    Leg& leg = legs.emplace_back();
    leg.foot = limb.end;
    for (const int joint : limb.joints) {
      if (uses[joint] == 1) leg.joints.push_back(joint);
    }
  }
  return legs;
}

}  // namespace

LegSearch find_legs(const RobotModel& robot) {
  constexpr double kRight = std::numbers::pi / 2.0;
  // z up, then y up and down, x up and down, z down. Rotations about x and y only: forward stays
  // close to x.
  const std::vector<Eigen::Vector3d> tries = {{0.0, 0.0, 0.0},     {kRight, 0.0, 0.0}, {-kRight, 0.0, 0.0},
                                              {0.0, -kRight, 0.0}, {0.0, kRight, 0.0}, {2.0 * kRight, 0.0, 0.0}};
  const Eigen::VectorXd joints = neutral_joints(robot);
  LegSearch search;
  std::vector<Limb> found, limbs;
  for (const Eigen::Vector3d& rpy : tries) {
    search.base_rpy = rpy;
    search.upright =
        (Eigen::AngleAxisd(rpy.y(), Eigen::Vector3d::UnitY()) * Eigen::AngleAxisd(rpy.x(), Eigen::Vector3d::UnitX()))
            .toRotationMatrix();
    RobotPose pose(robot, search.upright);
    pose.set(joints);
    limbs = find_limbs(pose.tree());
    found = standing_limbs(limbs, pose);
    if (!found.empty()) break;
  }
  if (found.empty()) {
    throw InputError(
        fmt::format("{}: no legs found: no two of its {} limbs reach down to the same level with all joints near 0; "
                    "write the robot file by hand (docs/adding-a-robot.md), or use the URDF of a legged robot",
                    robot.description().urdf.string(), limbs.size()));
  }
  search.legs = to_legs(found);
  for (const Limb& limb : limbs) {
    const bool is_leg = std::any_of(found.begin(), found.end(), [&](const Limb& leg) { return leg.end == limb.end; });
    if (!is_leg) search.other_ends.push_back(robot.joint_names()[limb.joints.back()]);
  }
  return search;
}

}  // namespace prowl

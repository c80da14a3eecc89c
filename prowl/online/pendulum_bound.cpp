#include "prowl/online/pendulum_bound.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/model/body_tree.hpp"

namespace prowl {
namespace {

/// Length of the stretched leg of a contact, from the second joint of the leg on [m]: the first turns the leg sideways.
double leg_length(const BodyTree& tree, int contact) {
  const BodyTree::Point& foot = tree.points[static_cast<std::size_t>(contact)];
  double length = foot.position.norm();
  for (int body = foot.body;;) {
    const RigidBody& moved = tree.bodies[static_cast<std::size_t>(body)];
    if (moved.parent <= 0 || tree.bodies[static_cast<std::size_t>(moved.parent)].parent <= 0) return length;
    length += moved.placement.translation().norm();
    body = moved.parent;
  }
}

}  // namespace

double pendulum_bound(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double height,
                      const SteppingPattern& pattern) {
  if (pattern.stands()) return 0.0;
  const BodyTree tree = body_tree(robot);
  double leg = std::numeric_limits<double>::infinity();
  for (const std::vector<int>& foot : feet) leg = std::min(leg, leg_length(tree, foot.front()));
  const double reach = std::sqrt(std::max(0.0, leg * leg - height * height));
  const double rate = std::sqrt(RobotModel::kGravity / height);
  const double step = pattern.stride / static_cast<double>(pattern.groups.size());
  // The capture point, kick / rate away, grows until the step, which may move the foot by the reach; what is left must
  // be within the reach of all later steps.
  const double growth = std::exp(-rate * step);
  return rate * std::exp(-0.5 * rate * step) * reach / (1.0 - growth);
}

}  // namespace prowl

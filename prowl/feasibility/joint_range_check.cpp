#include "prowl/feasibility/joint_range_check.hpp"

#include <algorithm>
#include <limits>
#include <numbers>
#include <queue>
#include <vector>

#include "prowl/dynamics/body_bounds.hpp"
#include "prowl/model/leg_kinematics.hpp"

namespace prowl {

namespace {

constexpr int kMostBoxes = 20000;   // 5 us each
constexpr double kTightness = 0.8;  // of the distance at some posture: a tighter bound tells no more

/// Positions of the joints of one leg: within `half` of `centre`.
struct Box {
  Eigen::VectorXd centre, half;
  double least = 0.0;  ///< distance of the point from its target, at least [m]
  bool operator<(const Box& other) const { return least > other.least; }  // the nearest is first in a queue
};

}  // namespace

double least_distance_within_limits(const RobotModel& robot, int contact, const Eigen::Vector3d& target,
                                    double margin) {
  const std::vector<JointLever> levers = joint_levers(robot, contact);
  const auto count = static_cast<Eigen::Index>(levers.size());
  Box all{Eigen::VectorXd(count), Eigen::VectorXd(count)};
  Eigen::VectorXd lever(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const auto& [joint, length] = levers[static_cast<std::size_t>(i)];
    double lower = robot.position_lower()(joint), upper = robot.position_upper()(joint);
    if (!robot.joint_is_prismatic()[static_cast<std::size_t>(joint)] && !(upper - lower < 2.0 * std::numbers::pi)) {
      lower = -std::numbers::pi;  // the joint turns all the way round
      upper = std::numbers::pi;
    }
    lever(i) = length;
    all.centre(i) = 0.5 * (lower + upper);
    all.half(i) = 0.5 * (upper - lower);
  }
  if (!lever.allFinite() || !all.half.allFinite()) return 0.0;

  LegKinematics leg(robot);
  Eigen::VectorXd joints = robot.nominal_configuration().tail(robot.nu());
  double nearest = std::numeric_limits<double>::infinity();  // at some posture
  const auto bound = [&](Box& box) {
    for (Eigen::Index i = 0; i < count; ++i) joints(levers[static_cast<std::size_t>(i)].joint) = box.centre(i);
    leg.update(joints);
    const double distance = (leg.position(contact) - target).norm();
    nearest = std::min(nearest, distance);
    box.least = std::max(box.least, distance - lever.dot(box.half));
  };
  std::priority_queue<Box> boxes;
  bound(all);
  boxes.push(std::move(all));
  for (int n = 0; n < kMostBoxes && nearest > margin && boxes.top().least < kTightness * nearest; ++n) {
    Box left = boxes.top();
    boxes.pop();
    Eigen::Index widest = 0;
    left.half.cwiseProduct(lever).maxCoeff(&widest);
    left.half(widest) *= 0.5;
    Box right = left;
    left.centre(widest) -= left.half(widest);
    right.centre(widest) += right.half(widest);
    bound(left);
    bound(right);
    boxes.push(std::move(left));
    boxes.push(std::move(right));
  }
  const double least = boxes.top().least;
  return nearest > margin && least > margin ? least : 0.0;
}

}  // namespace prowl

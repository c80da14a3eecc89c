#include "prowl/guess/posture_path.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "prowl/model/configuration.hpp"

namespace prowl {

using Eigen::VectorXd;

namespace {

/// World velocity of the base where a boundary constraint prescribes it.
std::optional<Eigen::Vector3d> prescribed_base_velocity(const BoundaryConstraint& constraint, const VectorXd& q) {
  const Eigen::Vector3d v = constraint.velocity_lower.head<3>();
  if (v != constraint.velocity_upper.head<3>()) return std::nullopt;
  return base_rotation(q) * v;
}

bool binds(const BoundaryConstraint& constraint, Eigen::Index i) {
  return std::isfinite(constraint.configuration_lower(i)) || std::isfinite(constraint.configuration_upper(i));
}

}  // namespace

VectorXd meet(const BoundaryConstraint& constraint, const VectorXd& q) {
  return integrate(constraint.q_ref, difference(constraint.q_ref, q)
                                         .cwiseMax(constraint.configuration_lower)
                                         .cwiseMin(constraint.configuration_upper));
}

PosturePath::PosturePath(const DiscreteProblem& discrete) : reference_(discrete.problem.reference) {
  std::vector<std::size_t> in_order(discrete.boundary_nodes.size());
  std::iota(in_order.begin(), in_order.end(), 0);
  std::ranges::stable_sort(in_order, {}, [&](std::size_t c) { return discrete.boundary_nodes[c]; });

  VectorXd q = discrete.problem.start_configuration();
  std::vector<std::vector<Waypoint>> waypoints(static_cast<std::size_t>(q.size() - 4));
  for (const std::size_t c : in_order) {
    const BoundaryConstraint& constraint = discrete.problem.boundary_constraints[c];
    q = meet(constraint, q);
    add(constraint, q, discrete.boundary_time(c), waypoints);
  }
  if (discrete.problem.cycle) add_cycle(discrete, waypoints);
  for (const auto& points : waypoints) curves_.emplace_back(points);
}

VectorXd PosturePath::operator()(double time) const {
  if (reference_) return reference_->at(time);
  VectorXd q(static_cast<Eigen::Index>(curves_.size()) + 4);
  for (std::size_t i = 0; i < curves_.size(); ++i) q(static_cast<Eigen::Index>(i < 3 ? i : i + 4)) = curves_[i](time);
  q.segment<4>(3) = rotation(time).coeffs();
  return q;
}

void PosturePath::add(const BoundaryConstraint& constraint, const VectorXd& q, double time,
                      std::vector<std::vector<Waypoint>>& waypoints) {
  const auto base_velocity = prescribed_base_velocity(constraint, q);
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    const auto coordinate = static_cast<Eigen::Index>(i);  // 0 ... 2 base position, then joints
    const Eigen::Index index = i < 3 ? coordinate : coordinate + 4;
    const Eigen::Index tangent = i < 3 ? coordinate : coordinate + 3;
    auto& points = waypoints[i];
    if (!binds(constraint, tangent) && !points.empty()) continue;
    // Two conditions at one time (a phase transition): the later one includes the earlier.
    if (!points.empty() && points.back().time >= time) points.pop_back();
    points.push_back({time, q(index), std::nullopt});
    if (i < 3 && base_velocity) points.back().slope = (*base_velocity)(coordinate);
  }
  if (turns_.empty() || binds(constraint, 3) || binds(constraint, 4) || binds(constraint, 5)) {
    if (!turns_.empty() && turns_.back().time >= time) turns_.pop_back();
    Eigen::Quaterniond rotation = base_quaternion(q);
    // The sign that continues without a jump.
    if (!turns_.empty() && turns_.back().rotation.dot(rotation) < 0.0) rotation.coeffs() *= -1.0;
    turns_.push_back({time, rotation});
  }
}

void PosturePath::add_cycle(const DiscreteProblem& discrete, std::vector<std::vector<Waypoint>>& waypoints) {
  const Cycle& cycle = *discrete.problem.cycle;
  const VectorXd& start = discrete.problem.start_configuration();
  const double time = discrete.nodes.back().time;
  const Eigen::Vector3d way = cycle.moved(base_position(start)) - base_position(start);
  for (const double share : {0.0, 1.0}) {
    const VectorXd q = share == 0.0 ? start : cycle.moved_configuration(start);
    BoundaryConstraint pose =
        BoundaryConstraint::unbounded(discrete.problem.robot, "cycle", PhaseFraction::start_of(0), q);
    pose.configuration_lower.setZero();
    pose.configuration_upper.setZero();
    const Eigen::AngleAxisd bend((share - 0.5) * cycle.turn, Eigen::Vector3d::UnitZ());  // from the chord of the arc
    pose.velocity_lower.head<3>() = pose.velocity_upper.head<3>() = base_rotation(q).transpose() * (bend * way) / time;
    add(pose, q, share * time, waypoints);
  }
}

Eigen::Quaterniond PosturePath::rotation(double time) const {
  const auto next = std::ranges::upper_bound(turns_, time, {}, &Turn::time);
  if (next == turns_.begin()) return turns_.front().rotation;
  if (next == turns_.end()) return turns_.back().rotation;
  const Turn& last = *std::prev(next);
  const double progress = MonotoneCubic({{last.time, 0.0, {}}, {next->time, 1.0, {}}})(time);
  return last.rotation.slerp(progress, next->rotation);
}

}  // namespace prowl

#include "prowl/transcription/cost_terms.hpp"

#include <algorithm>
#include <functional>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/all_contacts.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/motion/term_evaluation.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// A term as a function of one node.
struct WeightedTerm {
  std::string key;
  std::function<double(const TrajectoryPoint&)> value;
};

/// 1/2 sum_i weight_i x_i^2 over `size` entries from `first`.
double half_square(const VectorXd& weight, const VectorXd& x, Eigen::Index first, Eigen::Index size) {
  return 0.5 * weight.segment(first, size).dot(x.segment(first, size).cwiseAbs2());
}

double contact_position_cost(RigidBodyTerms& kinematics, const std::vector<ContactPositionCost>& costs,
                             const TrajectoryPoint& point) {
  kinematics.update_kinematics(point.q);
  double value = 0.0;
  for (const ContactPositionCost& cost : costs) {
    const Eigen::Vector3d error = kinematics.contact_position(cost.contact) - cost.reference;
    value += 0.5 * cost.weight.dot(error.cwiseAbs2());
  }
  return value;
}

double force_cost(const Eigen::Vector3d& weight, const VectorXd& force) {
  double value = 0.0;
  for (Eigen::Index row = 0; row < force.size(); row += 3) {
    value += 0.5 * weight.dot(force.segment<3>(row).cwiseAbs2());
  }
  return value;
}

/// Terms with a positive weight; acceleration, torque, force and time in a running cost only.
std::vector<WeightedTerm> weighted_terms(RigidBodyTerms& kinematics, const QuadraticCost& cost, bool is_running) {
  std::vector<WeightedTerm> terms;
  const auto add = [&](const std::string& key, const VectorXd& weight, Eigen::Index first, Eigen::Index size,
                       const std::function<VectorXd(const TrajectoryPoint&)>& of) {
    if (weight.segment(first, size).isZero(0.0)) return;
    terms.push_back({key, [=, &weight](const auto& point) { return half_square(weight, of(point), first, size); }});
  };
  const Eigen::Index nu = kinematics.nv() - 6;
  const auto off = [&cost](const TrajectoryPoint& point) { return difference(cost.q_ref, point.q); };
  const auto velocity = [](const TrajectoryPoint& point) { return point.v; };
  add("base_position", cost.configuration_weight, 0, 3, off);
  add("base_orientation", cost.configuration_weight, 3, 3, off);
  add("joint_position", cost.configuration_weight, 6, nu, off);
  add("base_linear_velocity", cost.velocity_weight, 0, 3, velocity);
  add("base_angular_velocity", cost.velocity_weight, 3, 3, velocity);
  add("joint_velocity", cost.velocity_weight, 6, nu, velocity);
  if (!cost.contact_positions.empty()) {
    terms.push_back({"contact_position", [&](const TrajectoryPoint& point) {
                       return contact_position_cost(kinematics, cost.contact_positions, point);
                     }});
  }
  if (!is_running) return terms;
  const auto acceleration = [](const TrajectoryPoint& point) { return point.a; };
  add("base_linear_acceleration", cost.acceleration_weight, 0, 3, acceleration);
  add("base_angular_acceleration", cost.acceleration_weight, 3, 3, acceleration);
  add("joint_acceleration", cost.acceleration_weight, 6, nu, acceleration);
  add("torque", cost.torque_weight, 0, nu,
      [&cost](const TrajectoryPoint& point) -> VectorXd { return point.tau - cost.tau_ref; });
  if (!cost.force_weight.isZero(0.0)) {
    terms.push_back(
        {"force", [&cost](const TrajectoryPoint& point) { return force_cost(cost.force_weight, point.force); }});
  }
  if (cost.time_weight != 0.0) {
    terms.push_back({"time", [&cost](const TrajectoryPoint&) { return cost.time_weight; }});
  }
  return terms;
}

/// Cost of a term of the user's: by the trapezoid over the intervals of its span, or at its moment.
CostTerm cost_of(const MotionProblem& problem, const TermUse& use, const Trajectory& motion,
                 RigidBodyTerms& kinematics) {
  const std::vector<TrajectoryPoint>& nodes = motion.nodes;
  CostTerm result{kOwnTerm + use.name, VectorXd::Zero(std::ssize(nodes)), 0.0};
  TermEvaluation term(problem.robot, use, all_contacts(problem.robot));  // those without contact have no force
  std::vector<bool> holds;
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto ends = std::ranges::equal_range(nodes, nodes[k].phase, {}, &TrajectoryPoint::phase);
    const double start = ends.front().time, duration = ends.back().time - start;
    holds.push_back(use.holds_at(nodes[k].phase, (nodes[k].time - start) / duration));
    if (!holds[k]) continue;
    kinematics.update_kinematics(nodes[k].q);
    term.evaluate({kinematics, nodes[k].q, nodes[k].v, nodes[k].tau, nodes[k].force, nodes[k].time});
    const VectorXd error = term.value() - use.reference;
    result.rate(static_cast<Eigen::Index>(k)) = 0.5 * error.dot(use.weight * error);
  }
  if (use.is_moment()) {
    result.cost = result.rate.sum();
    result.rate.setZero();
    return result;
  }
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    if (nodes[k].phase != nodes[k + 1].phase || !holds[k] || !holds[k + 1]) continue;
    result.cost +=
        0.5 * (nodes[k + 1].time - nodes[k].time) * result.rate.segment<2>(static_cast<Eigen::Index>(k)).sum();
  }
  return result;
}

/// Trapezoidal quadrature weights of the nodes [s].
VectorXd trapezoid_weights(const std::vector<TrajectoryPoint>& nodes) {
  VectorXd weights = VectorXd::Zero(std::ssize(nodes));
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    if (nodes[k].phase != nodes[k + 1].phase) continue;  // phase transition
    const double half = 0.5 * (nodes[k + 1].time - nodes[k].time);
    weights(static_cast<Eigen::Index>(k)) += half;
    weights(static_cast<Eigen::Index>(k) + 1) += half;
  }
  return weights;
}

}  // namespace

std::vector<CostTerm> cost_terms(const MotionProblem& problem, const Trajectory& motion) {
  std::vector<CostTerm> terms;
  const auto size = std::ssize(motion.nodes);
  if (size == 0) return terms;
  const VectorXd weights = trapezoid_weights(motion.nodes);
  RigidBodyTerms kinematics(problem.robot);
  for (const WeightedTerm& term : weighted_terms(kinematics, problem.running_cost, true)) {
    VectorXd rate(size);
    std::transform(motion.nodes.begin(), motion.nodes.end(), rate.begin(), term.value);
    const double cost = weights.dot(rate);
    terms.push_back({term.key, std::move(rate), cost});
  }
  for (const WeightedTerm& term : weighted_terms(kinematics, problem.terminal_cost, false)) {
    terms.push_back({kTerminalCost + term.key, VectorXd::Zero(size), term.value(motion.nodes.back())});
  }
  for (const TermUse& use : problem.terms) {
    if (use.is_cost()) terms.push_back(cost_of(problem, use, motion, kinematics));
  }
  return terms;
}

}  // namespace prowl

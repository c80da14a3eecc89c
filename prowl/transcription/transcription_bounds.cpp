#include "prowl/transcription/transcription_bounds.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/node/torque_rows.hpp"

namespace prowl {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// Nodes at the time of node k: itself and, at a phase transition, its twin.
std::vector<int> nodes_at_time_of(const DiscreteProblem& discrete, int k) {
  std::vector<int> nodes{k};
  const MeshNode& node = discrete.nodes[k];
  if (node.h_in == 0.0 && k > 0) nodes.push_back(k - 1);
  if (node.h_out == 0.0 && k + 1 < discrete.num_nodes()) nodes.push_back(k + 1);
  return nodes;
}

bool binds_rotation(const BoundaryConstraint& constraint) {
  return constraint.configuration_lower.segment<3>(3).maxCoeff() > -kInfinity ||
         constraint.configuration_upper.segment<3>(3).minCoeff() < kInfinity;
}

void tighten(VariableBounds& bounds, int first, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper,
             const std::string& what) {
  for (Eigen::Index i = 0; i < lower.size(); ++i) {
    double& lo = bounds.lower(first + i);
    double& up = bounds.upper(first + i);
    const double limit_lower = lo, limit_upper = up;
    lo = std::max(lo, lower(i));
    up = std::min(up, upper(i));
    // A start or goal on a limit of the robot, up to decimal rounding: use the limit.
    constexpr double kRounding = 1e-9;
    if (lo > up && lo <= up + kRounding) lo = up = std::clamp(lower(i), limit_lower, limit_upper);
    if (lo > up) {
      throw InputError(
          fmt::format("{}: asks for a value between {:.6g} and {:.6g}, which the robot's limits or another "
                      "condition at the same time exclude (entry {})",
                      what, lower(i), upper(i), i));
    }
  }
}

}  // namespace

std::vector<Eigen::Matrix3d> rotation_charts(const DiscreteProblem& discrete, const Trajectory& guess) {
  std::vector<Eigen::Matrix3d> charts;
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const int first = nodes_at_time_of(discrete, k).back() < k ? k - 1 : k;
    charts.push_back(base_rotation(guess.nodes[first].q));
  }
  if (discrete.problem.cycle) charts.back() = discrete.problem.cycle->rotation() * charts.front();
  for (std::size_t c = 0; c < discrete.boundary_nodes.size(); ++c) {
    const BoundaryConstraint& constraint = discrete.problem.boundary_constraints[c];
    if (!binds_rotation(constraint)) continue;
    for (const int k : nodes_at_time_of(discrete, discrete.boundary_nodes[c])) {
      charts[k] = base_rotation(constraint.q_ref);
    }
  }
  return charts;
}

VariableBounds variable_bounds(const DiscreteProblem& discrete, const DecisionLayout& layout) {
  const MotionProblem& problem = discrete.problem;
  const RobotModel& robot = problem.robot;
  const int nu = layout.nu();
  VariableBounds bounds;
  bounds.lower.setConstant(layout.num_variables(), -kInfinity);
  bounds.upper.setConstant(layout.num_variables(), kInfinity);
  Eigen::VectorXd torque_limit = robot.torque_limit();
  for (int j = 0; j < nu; ++j) {
    const double room = room_for_losses(robot, j);
    torque_limit(j) = std::isfinite(room) ? torque_limit(j) - room : kInfinity;  // TorqueRows contains it
  }
  for (int k = 0; k < layout.num_nodes(); ++k) {
    bounds.lower.segment(layout.q(k) + 6, nu) = robot.position_lower();
    bounds.upper.segment(layout.q(k) + 6, nu) = robot.position_upper();
    bounds.lower.segment(layout.v(k) + 6, nu) = -robot.velocity_limit();
    bounds.upper.segment(layout.v(k) + 6, nu) = robot.velocity_limit();
    bounds.lower.segment(layout.tau(k), nu) = -torque_limit;
    bounds.upper.segment(layout.tau(k), nu) = torque_limit;
    if (problem.margins.phases.empty()) continue;
    const MeshNode& node = discrete.nodes[k];
    const Margins::OfPhase& margins = problem.margins.phases[node.phase];
    const double fraction = discrete.mesh.phases[node.phase].node_time(node.node, 1.0);
    const Eigen::VectorXd torque = margin_at(margins.torque, fraction);
    Eigen::VectorXd joint = margin_at(margins.joint, fraction);
    if (std::ranges::count(discrete.boundary_nodes, k) > 0) joint.setZero();  // prescribed, perhaps near a limit
    bounds.lower.segment(layout.q(k) + 6, nu) += joint;
    bounds.upper.segment(layout.q(k) + 6, nu) -= joint;
    bounds.lower.segment(layout.tau(k), nu) += torque;
    bounds.upper.segment(layout.tau(k), nu) -= torque;
  }
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const Duration& duration = problem.phases[p].duration;
    if (layout.duration(p) < 0) continue;
    bounds.lower(layout.duration(p)) = duration.min;
    bounds.upper(layout.duration(p)) = duration.max;
  }
  const std::vector<ContactStance>& stances = discrete.schedule.stances();
  for (std::size_t s = 0; s < stances.size(); ++s) {
    const ContactStance& stance = stances[s];
    if (!stance.lands() || !stance.foothold) continue;
    const Surface& surface = problem.surfaces[stance.surface];
    const int first = layout.foothold(static_cast<int>(s));
    bounds.lower.segment<2>(first) = bounds.upper.segment<2>(first) = surface.coordinates(*stance.foothold);
  }
  for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[c];
    const int k = discrete.boundary_nodes[c];
    // The chart of the node is that of q_ref, so the variables are q_ref ⊕ tangent: add the
    // non-zero reference.
    Eigen::VectorXd reference(layout.nv());
    reference << base_position(constraint.q_ref), Eigen::Vector3d::Zero(), constraint.q_ref.tail(nu);
    tighten(bounds, layout.q(k), reference + constraint.configuration_lower, reference + constraint.configuration_upper,
            constraint.name + ", configuration");
    tighten(bounds, layout.v(k), constraint.velocity_lower, constraint.velocity_upper, constraint.name + ", velocity");
    tighten(bounds, layout.tau(k), constraint.torque_lower, constraint.torque_upper, constraint.name + ", torque");
  }
  if (problem.stands_at_end) {
    const int base = layout.a(layout.num_nodes() - 1);
    bounds.lower.segment<6>(base).setZero();
    bounds.upper.segment<6>(base).setZero();
  }
  return bounds;
}

}  // namespace prowl

// Construction of a centroidal program, and conversion between motions and variables.
#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "alternatives/centroidal/centroidal_nlp.hpp"
#include "alternatives/inverse_dynamics_check.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/decision_layout.hpp"
#include "prowl/transcription/node/independent_contacts.hpp"
#include "prowl/transcription/transcription_bounds.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Vector3d;
using Eigen::VectorXd;

bool binds_base_velocity(const BoundaryConstraint& constraint) {
  return constraint.velocity_lower.head<6>().array().isFinite().any() ||
         constraint.velocity_upper.head<6>().array().isFinite().any();
}

void refuse_torques(const MotionProblem& problem) {
  for (const BoundaryConstraint& constraint : problem.boundary_constraints) {
    const bool binds = (constraint.torque_lower.array() > -problem.robot.torque_limit().array()).any() ||
                       (constraint.torque_upper.array() < problem.robot.torque_limit().array()).any();
    if (!binds) continue;
    throw InputError(
        fmt::format("{}, torque: bounds are not allowed with dynamics \"centroidal\", which contain no "
                    "torques; need a goal without torques or other dynamics",
                    constraint.name));
  }
}

std::deque<CentroidalNode> nodes_of_phases(const DiscreteProblem& discrete, const Trajectory& guess) {
  const MotionProblem& problem = discrete.problem;
  std::deque<CentroidalNode> phases;
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const VectorXd& q = guess.nodes[discrete.mesh.first_node(p)].q;
    std::vector<bool> ties(discrete.mesh.phases[p].intervals() + 1, false);
    for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
      const MeshNode& node = discrete.nodes[discrete.boundary_nodes[c]];
      if (node.phase == p && binds_base_velocity(problem.boundary_constraints[c])) ties[node.node] = true;
    }
    const std::vector<LandingAxes> landing = phase_contacts(discrete, p, q).landing;
    phases.emplace_back(discrete, p, landing, centroidal_contacts(discrete, p, q, landing), ties);
  }
  return phases;
}

std::vector<int> rows_of_nodes(const std::deque<CentroidalNode>& phases, const DiscreteProblem& discrete) {
  std::vector<int> rows;
  for (const MeshNode& node : discrete.nodes) rows.push_back(phases[node.phase].num_rows(node.node));
  return rows;
}

std::vector<int> sliding_rows(const std::deque<CentroidalNode>& phases) {
  std::vector<int> rows;
  for (const CentroidalNode& phase : phases) rows.push_back(static_cast<int>(phase.contacts().sliding.size()));
  return rows;
}

VectorXd without_base_linear(VectorXd weight) {
  weight.head<3>().setZero();
  return weight;
}

}  // namespace

CentroidalNlp::CentroidalNlp(const DiscreteProblem& discrete, const Trajectory& guess)
    : MotionNlp(discrete),
      scale_(problem().robot),
      phases_(nodes_of_phases(discrete, guess)),
      layout_(discrete, rows_of_nodes(phases_, discrete), sliding_rows(phases_)),
      charts_(rotation_charts(discrete, guess)),
      acceleration_weight_(without_base_linear(problem().running_cost.acceleration_weight)),
      values_(discrete.nodes.size()) {
  refuse_torques(problem());
  set_bounds();
  set_patterns(guess);
}

// Bounds of start, goals, joints, velocities and durations are those of Transcription, where q and
// v have the same form.
void CentroidalNlp::set_bounds() {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::vector<int> none(discrete_.nodes.size(), 0);  // long enough for phases, too
  const DecisionLayout other(discrete_, none, none);
  const VariableBounds bounds = variable_bounds(discrete_, other);
  variable_lower_.setConstant(layout_.num_variables(), -kInfinity);
  variable_upper_.setConstant(layout_.num_variables(), kInfinity);
  const int size = 2 * problem().robot.nv();
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    variable_lower_.segment(layout_.node(k), size) = bounds.lower.segment(other.node(k), size);
    variable_upper_.segment(layout_.node(k), size) = bounds.upper.segment(other.node(k), size);
  }
  for (int p = 0; p < static_cast<int>(problem().phases.size()); ++p) {
    if (layout_.duration(p) < 0) continue;
    variable_lower_(layout_.duration(p)) = bounds.lower(other.duration(p));
    variable_upper_(layout_.duration(p)) = bounds.upper(other.duration(p));
  }
  constraint_lower_.setZero(layout_.num_constraints());
  constraint_upper_.setZero(layout_.num_constraints());
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    for (int row = 0; row < node(k).num_rows(mesh_node(k).node); ++row) {
      constraint_lower_(layout_.node_row(k) + row) = node(k).lower(mesh_node(k).node, row);
      constraint_upper_(layout_.node_row(k) + row) = node(k).upper(mesh_node(k).node, row);
    }
  }
}

VectorXd CentroidalNlp::pack(const Trajectory& trajectory) const {
  const int nv = problem().robot.nv(), nu = problem().robot.nu();
  VectorXd z = VectorXd::Zero(num_variables());
  CentroidalKinematics kinematics(problem().robot);
  RigidBodyTerms terms(problem().robot);
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const TrajectoryPoint& from = trajectory.nodes[k];
    const Phase& phase = problem().phases[phase_of(k)];
    const CentroidalColumns& at = layout_.columns(k);
    kinematics.update(from.q, from.v);
    terms.update_kinematics(from.q);
    auto x = z.segment(layout_.node(k), at.size);
    x.head<3>() = base_position(from.q);
    x.segment<3>(3) = so3::log(charts_[k].transpose() * base_rotation(from.q));
    x.segment(6, nu) = from.q.tail(nu);
    x.segment(at.v, nv) = from.v;
    x.segment<3>(at.com) = kinematics.com();
    x.segment<3>(at.com_velocity) = kinematics.momentum().head<3>() / problem().robot.mass();
    x.segment<3>(at.momentum) = kinematics.momentum().tail<3>();
    Vector3d force = Vector3d::Zero(), moment = Vector3d::Zero();
    for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
      const int contact = phase.contacts[i].contact, column = 3 * static_cast<int>(i);
      const Vector3d c = terms.contact_position(contact), f = from.force.segment<3>(3 * contact);
      x.segment<3>(at.contacts + column) = c;
      if (at.ends_interval()) x.segment<3>(at.forces + column) = f;
      force += f;
      moment += (c - kinematics.com()).cross(f);
    }
    if (at.ends_interval()) {
      x.segment<3>(at.com_acceleration) = force / problem().robot.mass() - RobotModel::kGravity * Vector3d::UnitZ();
      x.segment<3>(at.momentum_rate) = moment;
    }
    if (layout_.duration(phase_of(k)) >= 0 && mesh_node(k).h_out == 0.0) {
      z(layout_.duration(phase_of(k))) = planned_duration(trajectory, phase_of(k));
    }
  }
  return z;
}

Trajectory CentroidalNlp::unpack(const VectorXd& z) {
  if (!z.allFinite()) throw NumericalError("the variables of the motion are not finite");
  const int nv = problem().robot.nv();
  InverseDynamics needed(problem().robot);
  Trajectory motion;
  double time = 0.0;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    if (k > 0 && is_interval(k - 1)) time += step(z, k);
    // Forces and accelerations belong to the interval that ends at a node; a first node takes those
    // of the interval after it.
    const int end = layout_.columns(k).ends_interval() ? k : k + 1;
    const CentroidalColumns& at = layout_.columns(end);
    const auto velocity = [&](int i) { return z.segment(layout_.node(i) + layout_.columns(i).v, nv); };
    TrajectoryPoint& point = motion.nodes.emplace_back();
    point.time = time;
    point.phase = phase_of(k);
    point.q = node(k).configuration(this->point(z, k));
    point.v = velocity(k);
    point.a = (velocity(end) - velocity(end - 1)) / step(z, k);
    point.force.setZero(3 * static_cast<Index>(problem().robot.contacts().size()));
    const std::vector<int> contacts = contact_indices(problem().phases[point.phase].contacts);
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      point.force.segment<3>(3 * contacts[i]) = z.segment<3>(layout_.node(end) + at.forces + 3 * static_cast<int>(i));
    }
    point.tau = needed(point).tail(problem().robot.nu());
  }
  return motion;
}

std::unique_ptr<MotionNlp> make_centroidal(const Formulation& formulation, const DiscreteProblem& discrete,
                                           const Trajectory& guess) {
  const Formulation own{.dynamics = formulation.dynamics};
  const auto check = [](const char* what, const std::string& name, const std::string& needed) {
    if (name == needed) return;
    throw InputError(
        fmt::format("{}: \"{}\" is not available with dynamics \"centroidal\", which have their own rule; "
                    "need \"{}\"",
                    what, name, needed));
  };
  check("transcription", formulation.transcription, own.transcription);
  check("contact", formulation.contact, own.contact);
  check("orientation", formulation.orientation, own.orientation);
  return std::make_unique<CentroidalNlp>(discrete, guess);
}

}  // namespace prowl

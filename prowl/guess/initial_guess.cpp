#include "prowl/guess/initial_guess.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/projector.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/guess/contact_path.hpp"
#include "prowl/guess/posture_path.hpp"
#include "prowl/guess/support_path.hpp"
#include "prowl/model/configuration.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

VectorXd clamp(const VectorXd& x, const VectorXd& lower, const VectorXd& upper) {
  return x.cwiseMax(lower).cwiseMin(upper);
}

/// Configurations of all nodes: base and contacts on their paths; other joints change as on the posture path.
void set_configurations(const DiscreteProblem& discrete, Trajectory& guess) {
  const MotionProblem& problem = discrete.problem;
  const PosturePath posture(discrete);
  const ContactPath contacts(discrete, posture);
  const SupportPath support(discrete, posture, contacts);
  const int nu = problem.robot.nu();

  VectorXd previous = problem.start_configuration();
  VectorXd previous_on_path = posture(0.0);
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const MeshNode& node = discrete.nodes[k];
    VectorXd on_path = posture(node.time);
    on_path.head<2>() += support(node.time);
    VectorXd q = on_path;
    q.tail(nu) = previous.tail(nu) + on_path.tail(nu) - previous_on_path.tail(nu);
    q = inverse_kinematics(problem.robot, q, contacts.targets(k)).q;
    for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
      const bool is_now = discrete.boundary_time(c) == node.time;  // on both sides of a phase transition
      if (is_now) q = meet(problem.boundary_constraints[c], q);
    }
    q.tail(nu) = clamp(q.tail(nu), problem.robot.position_lower(), problem.robot.position_upper());
    guess.nodes[k].q = q;
    previous = q;
    previous_on_path = on_path;
  }
}

/// Contacts of the phases on both sides of node k: at a phase transition all of these hold still.
std::vector<int> contacts_around(const DiscreteProblem& discrete, int k) {
  const auto contacts_of = [&](int node) {
    const int phase = discrete.nodes[node].phase;
    return contact_indices(discrete.problem.phases[phase].contacts);
  };
  std::vector<int> contacts = contacts_of(k);
  const MeshNode& node = discrete.nodes[k];
  const int twin = node.h_in == 0.0 ? k - 1 : node.h_out == 0.0 ? k + 1 : k;
  if (twin < 0 || twin >= discrete.num_nodes()) return contacts;
  for (const int contact : contacts_of(twin)) {
    if (std::ranges::find(contacts, contact) == contacts.end()) contacts.push_back(contact);
  }
  return contacts;
}

/// Removes from v, or from a at this v, the part that moves the contacts: v - J⁺ J v, a - J⁺ (J a + J̇ v).
class ContactConsistency {
 public:
  ContactConsistency(const RobotModel& robot, const VectorXd& q, std::vector<int> contacts)
      : kinematics_(std::move(contacts)) {
    RigidBodyTerms terms(robot);
    terms.update_kinematics(q);
    kinematics_.set_configuration(terms);
    projector_.compute(kinematics_.jacobian());
  }
  void correct_velocity(VectorXd& v) {
    v -= kinematics_.jacobian().transpose() * (projector_.gram_inverse() * (kinematics_.jacobian() * v));
  }
  void correct_acceleration(const VectorXd& v, VectorXd& a) {
    kinematics_.set_motion(v, a);
    a -= kinematics_.jacobian().transpose() * (projector_.gram_inverse() * kinematics_.acceleration());
  }

 private:
  ContactKinematics kinematics_;
  Projector projector_;
};

/// Rate at node k of a quantity given at the nodes, from nodes `before` and `after` (k itself at an end): slope of the
/// parabola through all three, or a one-sided difference. `change(i)` is the value at i minus that at k.
template <typename Change>
VectorXd rate(const DiscreteProblem& discrete, int before, int k, int after, const Change& change) {
  const auto time = [&](int i) { return discrete.nodes[i].time; };
  if (before == k && after == k) return VectorXd::Zero(change(k).size());
  if (before == k) return change(after) / (time(after) - time(k));
  if (after == k) return -change(before) / (time(k) - time(before));
  const double h0 = time(k) - time(before), h1 = time(after) - time(k);
  return (change(after) * (h0 / h1) - change(before) * (h1 / h0)) / (h0 + h1);
}

/// Velocities and accelerations by differences, consistent with the contacts, within limits and boundary constraints.
void set_rates(const DiscreteProblem& discrete, Trajectory& guess) {
  const MotionProblem& problem = discrete.problem;
  const auto at = [&](int i) -> TrajectoryPoint& { return guess.nodes[i]; };
  const auto time = [&](int i) { return discrete.nodes[i].time; };
  const VectorXd& limit = problem.robot.velocity_limit();
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    // Neighbours in time, across phase transitions: the velocity is continuous there.
    int before = k, after = k;
    while (before > 0 && time(before) == time(k)) --before;
    while (after + 1 < discrete.num_nodes() && time(after) == time(k)) ++after;
    if (time(before) == time(k)) before = k;
    if (time(after) == time(k)) after = k;
    at(k).v = rate(discrete, before, k, after, [&](int i) {
      VectorXd d = difference(at(k).q, at(i).q);
      d.head<3>() = base_rotation(at(k).q).transpose() * d.head<3>();
      return d;
    });
    ContactConsistency(problem.robot, at(k).q, contacts_around(discrete, k)).correct_velocity(at(k).v);
    at(k).v.tail(problem.robot.nu()) = clamp(at(k).v.tail(problem.robot.nu()), -limit, limit);
  }
  for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[c];
    for (TrajectoryPoint& point : guess.nodes) {
      if (point.time != discrete.boundary_time(c)) continue;
      point.v = clamp(point.v, constraint.velocity_lower, constraint.velocity_upper);
    }
  }
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    // Neighbours of the same phase only: the acceleration jumps at a phase transition.
    const MeshNode& node = discrete.nodes[k];
    at(k).a = rate(discrete, node.h_in > 0.0 ? k - 1 : k, k, node.h_out > 0.0 ? k + 1 : k,
                   [&](int i) -> VectorXd { return at(i).v - at(k).v; });
    const Phase& phase = problem.phases[node.phase];
    ContactConsistency(problem.robot, at(k).q, contact_indices(phase.contacts)).correct_acceleration(at(k).v, at(k).a);
  }
}

/// Torques and forces of the motion, within limits. A contact that opens has no force at its last node.
void set_torques(const DiscreteProblem& discrete, Trajectory& guess) {
  const MotionProblem& problem = discrete.problem;
  const VectorXd& limit = problem.robot.torque_limit();
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    TrajectoryPoint& point = guess.nodes[k];
    const MeshNode& node = discrete.nodes[k];
    const auto& held = problem.phases[point.phase].contacts;
    std::vector<int> loaded;
    for (int i = 0; i < static_cast<int>(held.size()); ++i) {
      if (node.h_out > 0.0 || !discrete.schedule.opens(point.phase, i)) loaded.push_back(held[i].contact);
    }
    const StaticEquilibrium moving = equilibrium_in_motion(problem.robot, point.q, point.v, point.a, loaded);
    point.tau = clamp(moving.tau, -limit, limit);
    point.force = moving.force;
  }
  for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[c];
    VectorXd& tau = guess.nodes[discrete.boundary_nodes[c]].tau;
    tau = clamp(tau, constraint.torque_lower, constraint.torque_upper);
  }
}

}  // namespace

Trajectory initial_guess(const DiscreteProblem& discrete) {
  Trajectory guess;
  for (const MeshNode& node : discrete.nodes) {
    TrajectoryPoint point;
    point.time = node.time;
    point.phase = node.phase;
    guess.nodes.push_back(std::move(point));
  }
  set_configurations(discrete, guess);
  set_rates(discrete, guess);
  set_torques(discrete, guess);
  return guess;
}

}  // namespace prowl

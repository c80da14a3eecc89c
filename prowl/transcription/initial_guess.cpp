#include "prowl/transcription/initial_guess.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/contact_path.hpp"
#include "prowl/transcription/posture_path.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

VectorXd clamp(const VectorXd& x, const VectorXd& lower, const VectorXd& upper) {
  return x.cwiseMax(lower).cwiseMin(upper);
}

std::vector<int> active_contacts(const Phase& phase) {
  std::vector<int> contacts;
  for (const PhaseContact& contact : phase.contacts) contacts.push_back(contact.contact);
  return contacts;
}

/// Configurations of all nodes: the base on the path, contacts on theirs, other joints as the path has them (relative to
/// where the contacts left them).
void set_configurations(const MotionProblem& problem, const Mesh& mesh, Trajectory& guess) {
  const PosturePath posture(problem, mesh);
  const ContactPath contacts(problem, mesh, posture);
  const int nu = problem.robot.nu();

  VectorXd previous = problem.start_configuration();
  VectorXd previous_on_path = posture(0.0);
  for (int k = 0; k < mesh.size(); ++k) {
    const MeshNode& node = mesh.nodes[static_cast<std::size_t>(k)];
    const VectorXd on_path = posture(node.time);
    VectorXd q = on_path;
    q.tail(nu) = previous.tail(nu) + on_path.tail(nu) - previous_on_path.tail(nu);
    q = inverse_kinematics(problem.robot, q, contacts.targets(k)).q;
    for (const BoundaryCondition& condition : problem.boundary_conditions) {
      if (time_of(condition, mesh) == node.time) q = meet(condition, q);  // on both sides of a phase switch
    }
    q.tail(nu) = clamp(q.tail(nu), problem.robot.position_lower(), problem.robot.position_upper());
    guess.nodes[static_cast<std::size_t>(k)].q = q;
    previous = q;
    previous_on_path = on_path;
  }
}

/// A node of the mesh and its neighbours in time, across phase switches: -1 where there is none.
struct Neighbours {
  int before = -1, after = -1;
  Neighbours(const Mesh& mesh, int k) {
    const auto time = [&](int i) { return mesh.nodes[static_cast<std::size_t>(i)].time; };
    for (int i = k - 1; i >= 0 && before < 0; --i) before = time(i) < time(k) ? i : -1;
    for (int i = k + 1; i < mesh.size() && after < 0; ++i) after = time(i) > time(k) ? i : -1;
  }
};

/// Rate at node k of something that is known at the nodes: the slope there of the parabola through it and its
/// neighbours; at both ends of the motion the one-sided difference. `change(k, i)` is its value at i minus that at k.
template <typename Change>
VectorXd rate(const Trajectory& guess, const Neighbours& at, int k, const Change& change) {
  const auto time = [&](int i) { return guess.nodes[static_cast<std::size_t>(i)].time; };
  if (at.before < 0) return change(k, at.after) / (time(at.after) - time(k));
  if (at.after < 0) return -change(k, at.before) / (time(k) - time(at.before));
  const double h0 = time(k) - time(at.before), h1 = time(at.after) - time(k);
  return (change(k, at.after) * (h0 / h1) - change(k, at.before) * (h1 / h0)) / (h0 + h1);
}

/// Velocities and accelerations by differences, within limits and boundary conditions.
void set_rates(const MotionProblem& problem, const Mesh& mesh, Trajectory& guess) {
  const auto at = [&](int i) -> TrajectoryPoint& { return guess.nodes[static_cast<std::size_t>(i)]; };
  const auto displacement = [&](int k, int i) {
    VectorXd d = difference(at(k).q, at(i).q);
    d.head<3>() = base_rotation(at(k).q).transpose() * d.head<3>();
    return d;
  };
  const auto velocity_change = [&](int k, int i) -> VectorXd { return at(i).v - at(k).v; };
  const VectorXd& limit = problem.robot.velocity_limit();
  for (int k = 0; k < mesh.size(); ++k) {
    at(k).v = rate(guess, Neighbours(mesh, k), k, displacement);
    at(k).v.tail(problem.robot.nu()) = clamp(at(k).v.tail(problem.robot.nu()), -limit, limit);
  }
  for (const BoundaryCondition& condition : problem.boundary_conditions) {
    for (TrajectoryPoint& point : guess.nodes) {
      if (point.time == time_of(condition, mesh)) point.v = clamp(point.v, condition.velocity_lower, condition.velocity_upper);
    }
  }
  for (int k = 0; k < mesh.size(); ++k) at(k).a = rate(guess, Neighbours(mesh, k), k, velocity_change);
}

void set_torques(const MotionProblem& problem, const Mesh& mesh, Trajectory& guess) {
  const VectorXd& limit = problem.robot.torque_limit();
  for (TrajectoryPoint& point : guess.nodes) {
    const Phase& phase = problem.phases[static_cast<std::size_t>(point.phase)];
    const StaticEquilibrium rest = static_equilibrium(problem.robot, point.q, active_contacts(phase));
    point.tau = clamp(rest.tau, -limit, limit);
    point.force = rest.force;
  }
  for (const BoundaryCondition& condition : problem.boundary_conditions) {
    VectorXd& tau = guess.nodes[static_cast<std::size_t>(mesh.index(condition.at))].tau;
    tau = clamp(tau, condition.torque_lower, condition.torque_upper);
  }
}

}  // namespace

Trajectory initial_guess(const MotionProblem& problem, const Mesh& mesh) {
  Trajectory guess;
  for (const MeshNode& node : mesh.nodes) {
    TrajectoryPoint point;
    point.time = node.time;
    point.phase = node.phase;
    guess.nodes.push_back(std::move(point));
  }
  set_configurations(problem, mesh, guess);
  set_rates(problem, mesh, guess);
  set_torques(problem, mesh, guess);
  return guess;
}

}  // namespace prowl

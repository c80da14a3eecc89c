#include "prowl/transcription/initial_guess.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/dynamics/static_equilibrium.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/transcription/monotone_cubic.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

VectorXd clamp(const VectorXd& x, const VectorXd& lower, const VectorXd& upper) {
  return x.cwiseMax(lower).cwiseMin(upper);
}

double time_of(const BoundaryCondition& condition, const Mesh& mesh) {
  return mesh.nodes[static_cast<std::size_t>(mesh.index(condition.at))].time;
}

/// The configuration nearest to q that a boundary condition allows.
VectorXd meet(const BoundaryCondition& condition, const VectorXd& q) {
  return integrate(condition.q_ref, clamp(difference(condition.q_ref, q), condition.configuration_lower,
                                          condition.configuration_upper));
}

/// World velocity of the base where a boundary condition prescribes it.
std::optional<Eigen::Vector3d> prescribed_base_velocity(const BoundaryCondition& condition, const VectorXd& q) {
  const Eigen::Vector3d v = condition.velocity_lower.head<3>();
  if (v != condition.velocity_upper.head<3>()) return std::nullopt;
  return base_rotation(q) * v;
}

/// What the boundary conditions alone say about the motion: base and joints, contacts not considered. Each coordinate of
/// base position and joints has its own waypoints, so that one that is free at a condition goes on to the next; the
/// base's rotation turns from one prescribed rotation to the next about a fixed axis, at rest at both.
class PosturePath {
 public:
  PosturePath(const MotionProblem& problem, const Mesh& mesh) {
    std::vector<const BoundaryCondition*> conditions;
    for (const BoundaryCondition& condition : problem.boundary_conditions) conditions.push_back(&condition);
    std::ranges::stable_sort(conditions, {}, [&](const BoundaryCondition* c) { return mesh.index(c->at); });

    VectorXd q = problem.start_configuration();
    std::vector<std::vector<Waypoint>> waypoints(static_cast<std::size_t>(q.size() - 4));
    for (const BoundaryCondition* condition : conditions) {
      q = meet(*condition, q);
      add(*condition, q, time_of(*condition, mesh), waypoints);
    }
    for (const auto& points : waypoints) curves_.emplace_back(points);
  }

  VectorXd operator()(double time) const {
    VectorXd q(static_cast<Eigen::Index>(curves_.size()) + 4);
    for (std::size_t i = 0; i < curves_.size(); ++i) q(static_cast<Eigen::Index>(i < 3 ? i : i + 4)) = curves_[i](time);
    q.segment<4>(3) = rotation(time).coeffs();
    return q;
  }

 private:
  struct Turn {
    double time;
    Eigen::Quaterniond rotation;
  };

  static bool binds(const BoundaryCondition& condition, Eigen::Index i) {
    return std::isfinite(condition.configuration_lower(i)) || std::isfinite(condition.configuration_upper(i));
  }

  void add(const BoundaryCondition& condition, const VectorXd& q, double time,
           std::vector<std::vector<Waypoint>>& waypoints) {
    const auto base_velocity = prescribed_base_velocity(condition, q);
    for (std::size_t i = 0; i < waypoints.size(); ++i) {
      const auto coordinate = static_cast<Eigen::Index>(i);  // 0 ... 2 base position, then joints
      const Eigen::Index place = i < 3 ? coordinate : coordinate + 4;
      const Eigen::Index tangent = i < 3 ? coordinate : coordinate + 3;
      if (!binds(condition, tangent)) continue;
      // Two conditions at one time (both sides of a phase switch): the later has met the earlier.
      auto& points = waypoints[i];
      if (!points.empty() && points.back().time >= time) points.pop_back();
      points.push_back({time, q(place), std::nullopt});
      if (i < 3 && base_velocity) points.back().slope = (*base_velocity)(coordinate);
    }
    if (binds(condition, 3) || binds(condition, 4) || binds(condition, 5)) {
      if (!turns_.empty() && turns_.back().time >= time) turns_.pop_back();
      Eigen::Quaterniond rotation = base_quaternion(q);
      // Of the two quaternions of a rotation the one that goes on without a jump.
      if (!turns_.empty() && turns_.back().rotation.dot(rotation) < 0.0) rotation.coeffs() *= -1.0;
      turns_.push_back({time, rotation});
    }
  }

  Eigen::Quaterniond rotation(double time) const {
    const auto next = std::ranges::upper_bound(turns_, time, {}, &Turn::time);
    if (next == turns_.begin()) return turns_.front().rotation;
    if (next == turns_.end()) return turns_.back().rotation;
    const Turn& last = *std::prev(next);
    const double progress = MonotoneCubic({{last.time, 0.0, {}}, {next->time, 1.0, {}}})(time);
    return last.rotation.slerp(progress, next->rotation);
  }

  std::vector<MonotoneCubic> curves_;
  std::vector<Turn> turns_;
};

std::vector<int> active_contacts(const Phase& phase) {
  std::vector<int> contacts;
  for (const PhaseContact& contact : phase.contacts) contacts.push_back(contact.contact);
  return contacts;
}

/// Configurations of all nodes: the base on the path, active contacts at their places of the start, other joints as the
/// path has them (relative to where the last contact left them).
void set_configurations(const MotionProblem& problem, const Mesh& mesh, Trajectory& guess) {
  RigidBodyTerms start(problem.robot);
  start.update_kinematics(problem.start_configuration());
  const PosturePath path(problem, mesh);
  const int nu = problem.robot.nu();

  VectorXd previous = problem.start_configuration();
  VectorXd previous_on_path = path(0.0);
  for (std::size_t k = 0; k < mesh.nodes.size(); ++k) {
    const MeshNode& node = mesh.nodes[k];
    const VectorXd on_path = path(node.time);
    VectorXd q = on_path;
    q.tail(nu) = previous.tail(nu) + on_path.tail(nu) - previous_on_path.tail(nu);

    std::vector<ContactTarget> targets;
    for (const int contact : active_contacts(problem.phases[static_cast<std::size_t>(node.phase)])) {
      targets.push_back({contact, start.contact_position(contact)});
    }
    q = inverse_kinematics(problem.robot, q, targets).q;
    for (const BoundaryCondition& condition : problem.boundary_conditions) {
      if (time_of(condition, mesh) == node.time) q = meet(condition, q);  // on both sides of a phase switch
    }
    q.tail(nu) = clamp(q.tail(nu), problem.robot.position_lower(), problem.robot.position_upper());
    guess.nodes[k].q = q;
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

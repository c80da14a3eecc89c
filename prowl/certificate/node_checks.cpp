#include "prowl/certificate/node_checks.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/certificate/worst_case.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

using Limits = CertificateLimits;

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kSameTime = 1e-9;  // largest difference at a phase transition [s]

std::string node_name(std::size_t k) { return "node " + std::to_string(k); }

/// Fault of node k of the trajectory, "" if none.
std::string structure_fault(const MotionProblem& problem, const Trajectory& trajectory, std::size_t k, int phase) {
  const RobotModel& robot = problem.robot;
  const TrajectoryPoint& node = trajectory.nodes[k];
  const std::string name = node_name(k);
  if (node.phase != phase) return name + ": phase";
  if (node.q.size() != robot.nq() || node.v.size() != robot.nv() || node.a.size() != robot.nv()) return name + ": size";
  if (node.tau.size() != robot.nu()) return name + ": size of tau";
  if (node.force.size() != 3 * static_cast<Eigen::Index>(robot.contacts().size())) return name + ": size of force";
  if (k == 0) return node.time == 0.0 ? "" : name + ": time";
  const double step = node.time - trajectory.nodes[k - 1].time;
  const bool in_order = trajectory.nodes[k - 1].phase == phase ? step > 0.0 : std::abs(step) <= kSameTime;
  return in_order ? "" : name + ": time";
}

/// True for a tangent coordinate in metres, false for one in radians.
bool is_length(const RobotModel& robot, Eigen::Index i) {
  return i < 3 || (i >= 6 && robot.joint_is_prismatic()[i - 6]);
}

/// Distance of x outside [lower, upper]; negative inside, -inf if it is free.
double violation(double x, double lower, double upper) { return std::max(lower - x, x - upper); }

/// Worst violations of the start and the goals, one per kind of quantity.
struct BoundaryChecks {
  explicit BoundaryChecks(const GoalTolerance& tolerance)
      : position("goal position", "m", tolerance.position),
        angle("goal angle", "rad", tolerance.angle),
        velocity("goal velocity", "m/s", tolerance.velocity) {}

  WorstCase start{"start state", "m", Limits::start_state};
  WorstCase position, angle, velocity;
  WorstCase torque{"goal torque", "of limit", Limits::goal_torque};

  static void record(WorstCase& worst, double violation, double time, const std::string& where, const char* unit) {
    if (violation > -kInfinity) worst.record(violation, time, where, unit);
  }

  void state(const RobotModel& robot, const BoundaryConstraint& constraint, const TrajectoryPoint& node,
             bool is_start) {
    const Eigen::VectorXd offset = difference(constraint.q_ref, node.q);
    for (Eigen::Index i = 0; i < robot.nv(); ++i) {
      const bool in_metres = is_length(robot, i);
      const std::string where = constraint.name + ", " + coordinate_name(robot, i);
      record(is_start    ? start
             : in_metres ? position
                         : angle,
             violation(offset(i), constraint.configuration_lower(i), constraint.configuration_upper(i)), node.time,
             where, in_metres ? "m" : "rad");
      record(is_start ? start : velocity,
             violation(node.v(i), constraint.velocity_lower(i), constraint.velocity_upper(i)), node.time, where,
             in_metres ? "m/s" : "rad/s");
    }
  }

  void torques(const RobotModel& robot, const BoundaryConstraint& constraint, const TrajectoryPoint& node) {
    for (Eigen::Index i = 0; i < robot.nu(); ++i) {
      const double scale = std::isfinite(robot.torque_limit()(i)) ? robot.torque_limit()(i) : robot.weight() * 1.0;
      record(torque, violation(node.tau(i), constraint.torque_lower(i), constraint.torque_upper(i)) / scale, node.time,
             constraint.name + ", " + robot.joint_names()[i], "of limit");
    }
  }
};

void check_boundaries(const DiscreteProblem& discrete, const Trajectory& trajectory,
                      std::vector<CertificateCheck>& checks) {
  const MotionProblem& problem = discrete.problem;
  BoundaryChecks boundary(problem.goal_tolerance);
  for (std::size_t c = 0; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[c];
    const TrajectoryPoint& node = trajectory.nodes[discrete.boundary_nodes[c]];
    boundary.state(problem.robot, constraint, node, &constraint == &problem.start());
    boundary.torques(problem.robot, constraint, node);
  }
  boundary.start.append_to(checks);
  boundary.position.append_to(checks);
  boundary.angle.append_to(checks);
  boundary.velocity.append_to(checks);
  boundary.torque.append_to(checks);
}

/// The end of each cycle against its start, moved.
void check_cycles(const DiscreteProblem& discrete, const Trajectory& trajectory,
                  std::vector<CertificateCheck>& checks) {
  const MotionProblem& problem = discrete.problem;
  if (!problem.cycle) return;
  WorstCase jump("state after a cycle", "m", Limits::start_state);
  const int phases = problem.phases_of_cycle();
  for (int i = 0; i < problem.cycle->count; ++i) {
    const TrajectoryPoint& start = trajectory.nodes[discrete.mesh.first_node(i * phases)];
    const TrajectoryPoint& end = trajectory.nodes[discrete.mesh.last_node((i + 1) * phases - 1)];
    const Eigen::VectorXd moved = difference(problem.cycle->moved_configuration(start.q), end.q);
    for (Eigen::Index k = 0; k < moved.size(); ++k) {
      const bool in_metres = is_length(problem.robot, k);
      const std::string where = coordinate_name(problem.robot, k);
      jump.record(std::abs(moved(k)), end.time, where, in_metres ? "m" : "rad");
      jump.record(std::abs(end.v(k) - start.v(k)), end.time, where, in_metres ? "m/s" : "rad/s");
    }
  }
  jump.append_to(checks);
}

void check_continuity(const RobotModel& robot, const Trajectory& trajectory, std::vector<CertificateCheck>& checks) {
  WorstCase defect("defect", "-", Limits::defect);
  WorstCase jump("state at phase switch", "-", Limits::defect);
  WorstCase total("total defect", "-", Limits::total_defect_draft, Limits::total_defect_certified);
  const Eigen::VectorXd scale = state_scale(trajectory);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(scale.size());
  for (std::size_t k = 0; k + 1 < trajectory.nodes.size(); ++k) {
    const TrajectoryPoint& left = trajectory.nodes[k];
    const TrajectoryPoint& right = trajectory.nodes[k + 1];
    const bool inside = left.phase == right.phase;
    // A cubic always meets both nodes: its errors are integration errors.
    if (inside && trajectory.interpolation == Interpolation::hermite) continue;
    const TrajectoryPoint end = inside ? interpolate(left, right, right.time - left.time) : left;
    const Eigen::VectorXd gap = scaled_difference(end.q, end.v, right.q, right.v, scale).cwiseAbs();
    sum += gap;
    Eigen::Index i = 0;
    const double largest = gap.maxCoeff(&i);
    (inside ? defect : jump).record(largest, right.time, state_name(robot, i));
  }
  for (Eigen::Index i = 0; i < sum.size(); ++i) total.record(sum(i), trajectory.duration(), state_name(robot, i));
  defect.append_to(checks);
  jump.append_to(checks);
  total.append_to(checks);
}

void check_durations(const DiscreteProblem& discrete, const Trajectory& trajectory,
                     std::vector<CertificateCheck>& checks) {
  WorstCase duration("phase duration", "s", Limits::phase_duration);
  for (int p = 0; p < static_cast<int>(discrete.problem.phases.size()); ++p) {
    const Phase& phase = discrete.problem.phases[p];
    const double end = trajectory.nodes[discrete.mesh.last_node(p)].time;
    const double length = end - trajectory.nodes[discrete.mesh.first_node(p)].time;
    duration.record(violation(length, phase.duration.min, phase.duration.max), end, phase.name);
  }
  duration.append_to(checks);
}

}  // namespace

CertificateCheck structure_check(const DiscreteProblem& discrete, const Trajectory& trajectory) {
  WorstCase faults("nodes fit the problem", "-", 0.0);
  std::size_t k = 0;
  for (const MeshNode& node : discrete.nodes) {
    const bool exists = k < trajectory.nodes.size();
    const std::string fault =
        exists ? structure_fault(discrete.problem, trajectory, k, node.phase) : node_name(k) + ": missing";
    faults.record(fault.empty() ? 0.0 : 1.0, exists ? trajectory.nodes[k].time : 0.0, fault);
    ++k;
  }
  if (k < trajectory.nodes.size()) faults.record(1.0, trajectory.nodes[k].time, node_name(k) + ": extra");
  return faults.check();
}

CertificateCheck finite_check(const Trajectory& trajectory) {
  WorstCase worst("finite numbers, unit quaternions", "-", Limits::quaternion_norm);
  for (const TrajectoryPoint& node : trajectory.nodes) {
    const bool finite = std::isfinite(node.time) && node.q.allFinite() && node.v.allFinite() && node.a.allFinite() &&
                        node.tau.allFinite() && node.force.allFinite();
    const double norm_error = std::abs(base_quaternion(node.q).norm() - 1.0);
    worst.record(finite ? norm_error : std::numeric_limits<double>::quiet_NaN(), node.time, "");
  }
  return worst.check();
}

std::vector<CertificateCheck> node_checks(const DiscreteProblem& discrete, const Trajectory& trajectory) {
  std::vector<CertificateCheck> checks;
  check_boundaries(discrete, trajectory, checks);
  check_cycles(discrete, trajectory, checks);
  check_durations(discrete, trajectory, checks);
  check_continuity(discrete.problem.robot, trajectory, checks);
  return checks;
}

}  // namespace prowl

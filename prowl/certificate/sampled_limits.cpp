#include "prowl/certificate/sampled_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/certificate/ground_distance.hpp"
#include "prowl/certificate/term_checks.hpp"
#include "prowl/certificate/true_motion.hpp"
#include "prowl/certificate/worst_case.hpp"
#include "prowl/model/torque_share.hpp"

namespace prowl {
namespace {

using Limits = CertificateLimits;

/// Checks position and velocity of each contact.
class ContactChecks {
 public:
  ContactChecks(const MotionProblem& problem, const ContactStates& states) : problem_(problem), states_(states) {}

  void record(const TrajectoryPoint& point, const ConstrainedDynamicsOracle::ContactPoints& points) {
    for (std::size_t c = 0; c < problem_.robot.contacts().size(); ++c) {
      const auto& [name, frame, radius, offset] = problem_.robot.contacts()[c];
      const ContactState& state = states_[point.phase][c];
      const Eigen::Vector3d position = points.position.col(c);
      if (state.surface) {
        penetration_.record(radius - problem_.surfaces[*state.surface].distance(position), point.time, name);
        drift_.record((position - state.anchor).norm(), point.time, name);
        velocity_.record(points.velocity.col(c).norm(), point.time, name);
        continue;
      }
      for (const Surface& surface : problem_.surfaces) {
        penetration_.record(radius - distance_from_ground(surface, position), point.time, name);
      }
    }
  }

  void append_to(std::vector<CertificateCheck>& checks) const {
    for (const WorstCase* check : {&drift_, &velocity_, &penetration_}) check->append_to(checks);
  }

 private:
  const MotionProblem& problem_;
  const ContactStates& states_;
  WorstCase drift_{"contact drift", "m", Limits::contact_drift};
  WorstCase velocity_{"contact velocity", "m/s", Limits::contact_velocity};
  WorstCase penetration_{"penetration", "m", Limits::penetration};
};

/// Checks the clearance at the highest point of every swing, above the planes without an edge.
class SwingChecks {
 public:
  SwingChecks(const MotionProblem& problem, const ContactStates& states)
      : problem_(problem),
        states_(states),
        missing_("swing clearance missing", "m", Limits::missing_clearance * problem.swing_clearance),
        highest_(problem.robot.contacts().size(), kLow) {}

  /// Points in order of time.
  void record(const TrajectoryPoint& point, const ConstrainedDynamicsOracle::ContactPoints& points) {
    for (std::size_t c = 0; c < highest_.size(); ++c) {
      const ContactPoint& contact = problem_.robot.contacts()[c];
      if (states_[point.phase][c].swings) {
        highest_[c] = std::max(highest_[c], height(points.position.col(c)) - contact.radius);
      } else if (std::isfinite(highest_[c])) {
        if (problem_.swing_clearance > 0.0) {
          missing_.record(problem_.swing_clearance - highest_[c], point.time, contact.name);
        }
        highest_[c] = kLow;
      }
    }
  }

  void append_to(std::vector<CertificateCheck>& checks) const { missing_.append_to(checks); }

 private:
  static constexpr double kLow = -std::numeric_limits<double>::infinity();

  double height(const Eigen::Vector3d& position) const {
    double least = std::numeric_limits<double>::infinity();
    for (const Surface& surface : problem_.surfaces) {
      if (surface.patch.empty()) least = std::min(least, surface.distance(position));
    }
    return least;
  }

  const MotionProblem& problem_;
  const ContactStates& states_;
  WorstCase missing_;
  std::vector<double> highest_;  // height of each contact in its swing so far [m]
};

/// Checks the contact forces of the true dynamics.
class ForceChecks {
 public:
  ForceChecks(const MotionProblem& problem, const ContactStates& states)
      : problem_(problem),
        states_(states),
        friction_("friction cone", "N", Limits::force_over_weight * problem.robot.weight()),
        unilateral_("unilateral force", "N", Limits::force_over_weight * problem.robot.weight()),
        least_load_("least load of a held foot", "N", Limits::force_over_weight * problem.robot.weight()),
        planned_("planned contact force", "N", Limits::planned_force_over_weight * problem.robot.weight()) {}

  /// `at_end`: in the last interval of the phase. Returns the true forces, 3 per contact of the robot.
  Eigen::VectorXd record(const TrajectoryPoint& point, ConstrainedDynamicsOracle& dynamics, bool at_node, bool at_end) {
    const auto motion = true_motion(point, dynamics);
    acceleration_.record(motion.residual, point.time, "");
    const Phase& phase = problem_.phases[point.phase];
    for (const PhaseContact& held : phase.contacts) {
      const Surface& surface = problem_.surfaces[held.surface];
      const std::string& name = problem_.robot.contacts()[held.contact].name;
      const Eigen::Vector3d force = motion.force.segment<3>(3 * held.contact);
      const double normal = surface.normal.dot(force);
      const double tangential = (force - normal * surface.normal).norm();
      unilateral_.record(-normal, point.time, name);
      const double least = least_load(problem_, phase, held);
      const bool is_opening = at_end && states_[point.phase][held.contact].opens;
      if (least > 0.0 && !is_opening) least_load_.record(least - normal, point.time, name);
      // The unilateral check reports a pull; here it only allows no friction.
      friction_.record(tangential - surface.friction * std::max(normal, 0.0), point.time, name);
    }
    if (!at_node) return motion.force;  // between nodes the planned force is linear, the true one is not
    for (std::size_t c = 0; c < problem_.robot.contacts().size(); ++c) {
      const Eigen::Vector3d error = (point.force - motion.force).segment<3>(3 * static_cast<Eigen::Index>(c));
      planned_.record(error.norm(), point.time, problem_.robot.contacts()[c].name);
    }
    return motion.force;
  }

  void append_to(std::vector<CertificateCheck>& checks) const {
    for (const WorstCase* check : {&friction_, &unilateral_, &least_load_, &planned_, &acceleration_})
      check->append_to(checks);
  }

 private:
  const MotionProblem& problem_;
  const ContactStates& states_;
  WorstCase friction_, unilateral_, least_load_, planned_;
  WorstCase acceleration_{"contact acceleration", "m/s^2", Limits::contact_acceleration};
};

class JointChecks {
 public:
  explicit JointChecks(const RobotModel& robot) : robot_(robot) {}

  void record(const TrajectoryPoint& point) {
    for (int i = 0; i < robot_.nu(); ++i) {
      const double position = point.q(7 + i);
      const double outside = std::max(robot_.position_lower()(i) - position, position - robot_.position_upper()(i));
      const std::string& name = robot_.joint_names()[i];
      if (outside > -std::numeric_limits<double>::infinity())
        position_.record(outside, point.time, name, robot_.joint_is_prismatic()[i] ? "m" : "rad");
      velocity_.record(std::abs(point.v(6 + i)) / robot_.velocity_limit()(i), point.time, name);
      const double rate = point.v(6 + i), motor = point.tau(i) + robot_.losses().torque(i, rate);
      torque_.record(torque_share(robot_, i, position, rate, motor), point.time, name);
    }
  }

  void append_to(std::vector<CertificateCheck>& checks) const {
    for (const WorstCase* check : {&position_, &velocity_, &torque_}) check->append_to(checks);
  }

 private:
  const RobotModel& robot_;
  WorstCase position_{"joint position beyond limit", "rad", Limits::joint_position};
  WorstCase velocity_{"joint velocity", "of limit", Limits::velocity_ratio};
  WorstCase torque_{"joint torque", "of limit", Limits::torque_ratio};
};

}  // namespace

std::vector<CertificateCheck> sampled_limits(const DiscreteProblem& discrete, const Trajectory& trajectory,
                                             const ContactStates& states, PhaseDynamics& dynamics) {
  const MotionProblem& problem = discrete.problem;
  ContactChecks contacts(problem, states);
  SwingChecks swings(problem, states);
  ForceChecks forces(problem, states);
  JointChecks joints(problem.robot);
  TermChecks terms(discrete);
  for (const MeshInterval& interval : mesh_intervals(trajectory)) {
    const double h = interval.step();
    const int left = static_cast<int>(&interval.left - trajectory.nodes.data());
    const int pieces = std::max(Limits::grid_intervals, static_cast<int>(std::ceil(h / Limits::grid_step)));
    for (int i = 0; i <= pieces; ++i) {
      const TrajectoryPoint point = interval.at(h * i / pieces);
      const auto points = dynamics[point.phase].contact_points(point.q, point.v);
      contacts.record(point, points);
      swings.record(point, points);
      const bool is_end = i == 0 || i == pieces;
      const Eigen::VectorXd force = forces.record(point, dynamics[point.phase], is_end, interval.ends_phase);
      joints.record(point);
      terms.record(point, force, left, i == 0 ? left : i == pieces ? left + 1 : -1);
    }
  }
  std::vector<CertificateCheck> checks;
  contacts.append_to(checks);
  swings.append_to(checks);
  forces.append_to(checks);
  joints.append_to(checks);
  terms.append_to(checks);
  return checks;
}

}  // namespace prowl

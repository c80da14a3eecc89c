#include "prowl/trajectory/sampled_limits.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/trajectory/contact_places.hpp"
#include "prowl/trajectory/worst_case.hpp"

namespace prowl {
namespace {

using Limits = CertificateLimits;

/// Where each contact is, against where it has to be.
class ContactChecks {
 public:
  ContactChecks(const MotionProblem& problem, const Trajectory& trajectory, PhaseDynamics& dynamics)
      : problem_(problem), places_(contact_places(problem, trajectory, dynamics)) {
    for (const auto& phase : places_) {
      for (std::size_t c = 0; c < phase.size(); ++c) {
        if (phase[c].closes) gap_.record(std::abs(gap(phase[c].anchor, c, *phase[c].surface)), phase[c].time, name(c));
      }
    }
  }

  void record(const TrajectoryPoint& point, ConstrainedDynamicsOracle& dynamics) {
    const auto points = dynamics.contact_points(point.q, point.v);
    for (std::size_t c = 0; c < problem_.robot.contacts().size(); ++c) {
      const ContactPlace& place = places_[point.phase][c];
      const Eigen::Vector3d position = points.position.col(c);
      double depth = std::numeric_limits<double>::infinity();
      for (int surface : place.outside_one_of) depth = std::min(depth, -gap(position, c, surface));
      penetration_.record(depth, point.time, name(c));
      if (!place.surface) continue;
      drift_.record((position - place.anchor).norm(), point.time, name(c));
      velocity_.record(points.velocity.col(c).norm(), point.time, name(c));
    }
  }

  void append_to(std::vector<CertificateCheck>& checks) const {
    for (const WorstCase* check : {&gap_, &drift_, &velocity_, &penetration_}) check->append_to(checks);
  }

 private:
  const std::string& name(std::size_t contact) const { return problem_.robot.contacts()[contact].name; }
  double gap(const Eigen::Vector3d& position, std::size_t contact, int surface) const {
    return problem_.surfaces[surface].distance(position) - problem_.robot.contacts()[contact].radius;
  }

  const MotionProblem& problem_;
  ContactPlaces places_;
  WorstCase gap_{"contact gap at closing", "m", Limits::contact_gap};
  WorstCase drift_{"contact drift", "m", Limits::contact_drift};
  WorstCase velocity_{"contact velocity", "m/s", Limits::contact_velocity};
  WorstCase penetration_{"penetration", "m", Limits::penetration};
};

/// What the ground has to do for the motion, by the true dynamics.
class ForceChecks {
 public:
  explicit ForceChecks(const MotionProblem& problem)
      : problem_(problem),
        friction_("friction cone", "N", Limits::force_over_weight * problem.robot.weight()),
        unilateral_("unilateral force", "N", Limits::force_over_weight * problem.robot.weight()),
        planned_("planned contact force", "N", Limits::planned_force_over_weight * problem.robot.weight()) {}

  void record(const TrajectoryPoint& point, ConstrainedDynamicsOracle& dynamics, bool at_node) {
    const auto motion = dynamics.evaluate(point.q, point.v, point.tau);
    acceleration_.record(motion.residual, point.time, "");
    for (const PhaseContact& held : problem_.phases[point.phase].contacts) {
      const Surface& surface = problem_.surfaces[held.surface];
      const std::string& name = problem_.robot.contacts()[held.contact].name;
      const Eigen::Vector3d force = motion.force.segment<3>(3 * held.contact);
      const double normal = surface.normal.dot(force);
      const double tangential = (force - normal * surface.normal).norm();
      unilateral_.record(-normal, point.time, name);
      // A pull is the unilateral check's: here it only leaves no room for friction.
      friction_.record(tangential - surface.friction * std::max(normal, 0.0), point.time, name);
    }
    if (!at_node) return;  // between nodes the planned force is linear, which the true one is not
    for (std::size_t c = 0; c < problem_.robot.contacts().size(); ++c) {
      const Eigen::Vector3d error = (point.force - motion.force).segment<3>(3 * static_cast<Eigen::Index>(c));
      planned_.record(error.norm(), point.time, problem_.robot.contacts()[c].name);
    }
  }

  void append_to(std::vector<CertificateCheck>& checks) const {
    for (const WorstCase* check : {&friction_, &unilateral_, &planned_, &acceleration_}) check->append_to(checks);
  }

 private:
  const MotionProblem& problem_;
  WorstCase friction_, unilateral_, planned_;
  WorstCase acceleration_{"contact acceleration", "m/s^2", Limits::contact_acceleration};
};

class JointChecks {
 public:
  explicit JointChecks(const RobotModel& robot) : robot_(robot) {}

  void record(const TrajectoryPoint& point) {
    for (Eigen::Index i = 0; i < robot_.nu(); ++i) {
      const double position = point.q(7 + i);
      const double outside = std::max(robot_.position_lower()(i) - position, position - robot_.position_upper()(i));
      const std::string& name = robot_.joint_names()[i];
      if (outside > -std::numeric_limits<double>::infinity()) position_.record(outside, point.time, name);
      velocity_.record(std::abs(point.v(6 + i)) / robot_.velocity_limit()(i), point.time, name);
      torque_.record(std::abs(point.tau(i)) / robot_.torque_limit()(i), point.time, name);
    }
  }

  void append_to(std::vector<CertificateCheck>& checks) const {
    for (const WorstCase* check : {&position_, &velocity_, &torque_}) check->append_to(checks);
  }

 private:
  const RobotModel& robot_;
  WorstCase position_{"joint position beyond limit", "SI", Limits::joint_position};
  WorstCase velocity_{"joint velocity", "of limit", Limits::velocity_ratio};
  WorstCase torque_{"joint torque", "of limit", Limits::torque_ratio};
};

}  // namespace

std::vector<CertificateCheck> sampled_limits(const MotionProblem& problem, const Trajectory& trajectory,
                                             PhaseDynamics& dynamics) {
  ContactChecks contacts(problem, trajectory, dynamics);
  ForceChecks forces(problem);
  JointChecks joints(problem.robot);
  for (const MeshInterval& interval : mesh_intervals(trajectory)) {
    const double h = interval.step();
    const int pieces = std::max(Limits::grid_intervals, static_cast<int>(std::ceil(h / Limits::grid_step)));
    for (int i = 0; i <= pieces; ++i) {
      const TrajectoryPoint point = interpolate(interval.left, interval.right, h * i / pieces);
      contacts.record(point, dynamics[point.phase]);
      forces.record(point, dynamics[point.phase], i == 0 || i == pieces);
      joints.record(point);
    }
  }
  std::vector<CertificateCheck> checks;
  contacts.append_to(checks);
  forces.append_to(checks);
  joints.append_to(checks);
  return checks;
}

}  // namespace prowl

#include "prowl/simulation/measures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"

namespace prowl {
namespace {

constexpr double kAtOnce = 1e-3;  ///< [s]; the last sample of a run may be so much before its end

}  // namespace

Measures::Measures(const MotionProblem& problem, const Tracker& tracker, const Physics& physics, double end)
    : problem_(problem),
      tracker_(tracker),
      physics_(physics),
      end_(end),
      slip_now_(problem.robot.contacts().size(), Eigen::Vector3d::Zero()),
      slip_(problem.robot.contacts().size(), 0.0),
      touches_(problem.robot.contacts().size()) {
  const auto& segments = tracker.plan().segments;
  const auto time = [&](const PhaseFraction& at) {
    const TrackingPlan::Segment& segment = segments[static_cast<std::size_t>(at.phase)];
    return segment.start + at.fraction * (segment.end - segment.start);
  };
  for (std::size_t c = 1; c < problem.boundary_constraints.size(); ++c) {
    const BoundaryConstraint& goal = problem.boundary_constraints[c];
    moments_.push_back({time(goal.at), &goal, ""});
  }
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    if (!problem.phases[p].contacts.empty()) continue;
    moments_.push_back({time({static_cast<int>(p), 0.5}), nullptr, problem.phases[p].name});
  }
  std::ranges::stable_sort(moments_, {}, &Moment::time);
}

/// Distance of each entry from its bounds.
void Measures::add_moment(const Moment& moment, const SimulationSample& sample) {
  if (!moment.goal) {
    result_.flights.push_back({moment.phase, (sample.q_ref - sample.q).z()});
    return;
  }
  const BoundaryConstraint& goal = *moment.goal;
  const Eigen::VectorXd at = difference(goal.q_ref, sample.q);
  const Eigen::VectorXd off =
      (at - at.cwiseMax(goal.configuration_lower).cwiseMin(goal.configuration_upper)).cwiseAbs();
  GoalError error{goal.name, off.head<3>().norm(), off.segment<3>(3).norm(), 0.0, ""};
  Eigen::Index worst = 0;
  if (off.size() > 6) error.joint = off.tail(off.size() - 6).maxCoeff(&worst);
  if (error.joint > 0.0) error.worst_joint = problem_.robot.joint_names()[static_cast<std::size_t>(worst)];
  result_.goals.push_back(std::move(error));
}

void Measures::add(const SimulationSample& sample, const std::vector<Eigen::Vector3d>& slip) {
  const RobotModel& robot = problem_.robot;
  const bool at_rest = sample.time >= end_ - kRestWindow;
  const Eigen::VectorXd seen = difference(sample.q, sample.q_seen);
  error_.add(sample.q_ref, sample.q, at_rest);
  estimated_position_.add(seen.head<3>().norm(), at_rest);
  estimated_angle_.add(seen.segment<3>(3).norm(), at_rest);
  estimated_velocity_.add((sample.v_seen - sample.v).head<3>().norm(), at_rest);
  estimated_rates_.add((sample.v_seen - sample.v).tail(robot.nu()).norm() / std::sqrt(robot.nu()), at_rest);

  const TrackingPlan::Segment& segment = tracker_.segment(sample.time);
  for (; next_moment_ < moments_.size() && moments_[next_moment_].time <= sample.time + kAtOnce; ++next_moment_)
    add_moment(moments_[next_moment_], sample);
  times_.push_back(sample.time);
  for (std::size_t c = 0; c < slip_.size(); ++c) {
    touches_[c].push_back({sample.contacts[c].surface, sample.contacts[c].position});
    slip_now_[c] = segment.in_contact[c] ? Eigen::Vector3d(slip_now_[c] + slip[c]) : Eigen::Vector3d::Zero();
    slip_[c] = std::max(slip_[c], slip_now_[c].norm());
  }
}

void Measures::add_touch(const std::string& what, double t) {
  if (touched_.insert(what).second) result_.touches.push_back(fmt::format("{} at {:.3f} s", what, t));
}

void Measures::add_torques(const Actuators& actuators, const Eigen::VectorXd& tau, const Eigen::VectorXd& v,
                           double dt) {
  if (actuators.largest_share() > result_.largest_torque_share) {
    result_.largest_torque_share = actuators.largest_share();
    result_.largest_torque_joint = problem_.robot.joint_names()[actuators.most_used()];
  }
  if (times_.empty() || times_.back() > tracker_.end()) return;  // rest would hide what the motion needs
  result_.positive_work += dt * tau.cwiseProduct(v.tail(tau.size())).cwiseMax(0.0).sum();
  time_ += dt;
  if (actuators.saturated()) saturated_ += dt;
}

/// The first (landing) or last (lift-off) touch of a foot between `from` and `to`: of any of the corners of a flat one.
std::optional<Measures::Found> Measures::touch_near(int contact, double from, double to, bool lands) const {
  const std::vector<ContactPoint>& contacts = problem_.robot.contacts();
  std::optional<Found> found;
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (times_[i] < from || times_[i] > to) continue;
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      if (contacts[c].frame != contacts[static_cast<std::size_t>(contact)].frame || touches_[c][i].surface < 0)
        continue;
      found = {i, c};
      if (lands) return found;
    }
  }
  return found;
}

/// Of a contact that holds in this segment.
int Measures::planned_surface(int contact, std::size_t segment) const {
  const auto& held = phase_of_segment(problem_, segment).contacts;
  const auto found = std::ranges::find(held, contact, &PhaseContact::contact);
  return found == held.end() ? -1 : found->surface;
}

/// At the start of a segment, looked for between `from` and `to`.
void Measures::add_switch(int contact, bool lands, std::size_t segment, double swing, double from, double to) {
  ContactSwitch change{contact, lands, tracker_.plan().segments[segment].start, std::nan(""), swing};
  if (const auto touch = touch_near(contact, from, to, lands)) {
    const Touch& at = touches_[touch->contact][touch->sample];
    change.measured = times_[touch->sample];
    if (lands) {
      const int planned = planned_surface(contact, segment);
      Eigen::VectorXd q(problem_.robot.nq()), v(problem_.robot.nv());
      tracker_.reference(change.planned, q, v);
      const Eigen::Vector3d off = at.position - physics_.contact_positions(q)[touch->contact];
      const Eigen::Vector3d& normal = problem_.surfaces[static_cast<std::size_t>(planned)].normal;
      change.off = (off - normal.dot(off) * normal).norm();
      change.on_its_surface = at.surface == planned;
    }
  }
  result_.switches.push_back(change);
}

/// A touch of a contact that the plan holds in the air from the start or until the end.
void Measures::add_stray(int contact, double from, double to) {
  const auto touch = touch_near(contact, from, to, true);
  if (touch) add_touch(problem_.robot.contacts()[touch->contact].name + ", held in the air", times_[touch->sample]);
}

SimulationResult Measures::result() {
  SimulationResult& result = result_;
  result.base_position = error_.base_position();
  result.base_angle = error_.base_angle();
  result.joints = error_.joints();
  result.estimated_position = estimated_position_.measure();
  result.estimated_angle = estimated_angle_.measure();
  result.estimated_velocity = estimated_velocity_.measure();
  result.estimated_joint_rate = estimated_rates_.measure().rms;
  result.slip = slip_;
  result.saturated = time_ > 0.0 ? saturated_ / time_ : 0.0;

  const auto& segments = tracker_.plan().segments;
  for (std::size_t c = 0; c < slip_.size(); ++c) {
    const int contact = static_cast<int>(c);
    for (std::size_t s = 0; s < segments.size(); ++s) {
      if (segments[s].in_contact[c]) continue;
      std::size_t last = s;  // a swing may last several segments
      while (last + 1 < segments.size() && !segments[last + 1].in_contact[c]) ++last;
      const double off = segments[s].start, on = segments[last].end, middle = 0.5 * (off + on);
      // The stances before and after may last several, too; with short ones a touch may be late by more than one.
      std::size_t first = s, stance = last;
      while (first > 0 && segments[first - 1].in_contact[c]) --first;
      while (stance + 1 < segments.size() && segments[stance + 1].in_contact[c]) ++stance;
      const double before = segments[first].start, after = segments[stance].end;
      s > 0 ? add_switch(contact, false, s, on - off, before, middle) : add_stray(contact, off, middle);
      last + 1 < segments.size() ? add_switch(contact, true, last + 1, on - off, middle, after)
                                 : add_stray(contact, middle, end_);
      s = last;
    }
  }
  std::ranges::stable_sort(result.switches, {}, &ContactSwitch::planned);
  return result;
}

}  // namespace prowl

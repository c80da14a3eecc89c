#include "prowl/simulation/measures.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/model/configuration.hpp"

namespace prowl {

Measures::Measures(const MotionProblem& problem, const Tracker& tracker, double end)
    : problem_(problem),
      tracker_(tracker),
      end_(end),
      slip_now_(problem.robot.contacts().size(), Eigen::Vector3d::Zero()),
      slip_(problem.robot.contacts().size(), 0.0),
      touches_(problem.robot.contacts().size()) {}

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
  times_.push_back(sample.time);
  for (std::size_t c = 0; c < slip_.size(); ++c) {
    touches_[c].push_back(sample.contacts[c].touches);
    slip_now_[c] = segment.in_contact[c] ? Eigen::Vector3d(slip_now_[c] + slip[c]) : Eigen::Vector3d::Zero();
    slip_[c] = std::max(slip_[c], slip_now_[c].norm());
  }
}

void Measures::add_torques(const Actuators& actuators, const Eigen::VectorXd& tau, const Eigen::VectorXd& v,
                           double dt) {
  if (actuators.largest_share() > result_.largest_torque_share) {
    result_.largest_torque_share = actuators.largest_share();
    result_.largest_torque_joint = problem_.robot.joint_names()[actuators.most_used()];
  }
  result_.positive_work += dt * tau.cwiseProduct(v.tail(tau.size())).cwiseMax(0.0).sum();
  time_ += dt;
  if (actuators.saturated()) saturated_ += dt;
}

/// Time of the first (landing) or last (opening) touch between `from` and `to`; NaN without one.
double Measures::touch_near(int contact, double from, double to, bool lands) const {
  const auto& touches = touches_[contact];
  double found = std::nan("");
  for (std::size_t i = 0; i < times_.size(); ++i) {
    if (times_[i] < from || times_[i] > to || !touches[i]) continue;
    found = times_[i];
    if (lands) break;
  }
  return found;
}

SimulationResult Measures::result() const {
  SimulationResult result = result_;
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
      const double before = s > 0 ? segments[s - 1].start : 0.0;
      const double after = last + 1 < segments.size() ? segments[last + 1].end : on;
      if (s > 0) result.switches.push_back({contact, false, off, touch_near(contact, before, middle, false)});
      if (last + 1 < segments.size()) {
        result.switches.push_back({contact, true, on, touch_near(contact, middle, after, true)});
      }
      s = last;
    }
  }
  std::ranges::stable_sort(result.switches, {}, &ContactSwitch::planned);
  return result;
}

}  // namespace prowl

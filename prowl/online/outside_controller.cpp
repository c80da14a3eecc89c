#include "prowl/online/outside_controller.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kStands = 0.7;  ///< from the start on, as an MpcController does [s]

/// Holds the robot where it stands until the first plan acts.
MpcPlan standing_plan(const RobotModel& robot, const std::vector<std::vector<int>>& feet, const VectorXd& q, double t) {
  MpcPlan plan(robot, 1, std::numeric_limits<double>::infinity());
  plan.steps() = {standing_step(robot, feet, q)};
  plan.steps().front().start = t;
  plan.steps().front().length = kStands;
  return plan;
}

bool is_finite_step(const MpcPlan::Step& step) {
  return step.q.allFinite() && step.v.allFinite() && step.a.allFinite() && step.tau.allFinite() &&
         step.gain.allFinite();
}

}  // namespace

OutsideController::OutsideController(const RobotModel& robot, Planner planner, double delay, const VectorXd& q,
                                     double t)
    : robot_(robot),
      planner_(std::move(planner)),
      delay_(delay),
      feet_(contacts_of_feet(robot)),
      standing_(q),
      timeline_(static_cast<int>(feet_.size()), t),
      lead_(standing_, q, t),
      plans_(robot_, standing_plan(robot_, feet_, q, t)),
      prediction_(robot_, feet_) {
  timeline_.extend(t, t + kStands);
}

void OutsideController::feel_contacts(const std::vector<bool>& touches, double t) {
  timeline_.feel(touches, t, delay_);
}

bool OutsideController::prepare(double t) {
  ++counters_.updates;
  start_ = t + delay_;
  timeline_.extend(start_, start_ + MotionRequest::kPlannedAhead);
  lead_.advance(start_);
  return true;
}

bool OutsideController::plan(const VectorXd& q, const VectorXd& v, double t) {
  if (!q.allFinite() || !v.allFinite()) {
    ++counters_.failed;
    ++counters_.bad_states;
    return false;
  }
  q_ = q;
  v_ = v;
  prediction_.predict(plans_, timeline_, t, start_, q_, v_);
  lead_.stay_near(q_, robot_.size());
  const MotionRequest request{.time = t,
                              .start = start_,
                              .q = q_,
                              .v = v_,
                              .timeline = timeline_,
                              .command = lead_.followed(),
                              .pose = lead_.pose()};
  const std::optional<double> seconds = planner_(request, steps_);
  computing_time_ = seconds.value_or(0.0);
  if (!seconds || steps_.empty() || !std::ranges::all_of(steps_, is_finite_step)) {
    ++counters_.failed;
    return false;
  }
  for (MpcPlan::Step& step : steps_) step.standing = timeline_.standing(step.start + 0.5 * step.length);
  plans_.begin_next().steps() = steps_;
  return true;
}

void OutsideController::torque(double t, const VectorXd& q, const VectorXd& v, VectorXd& tau) {
  if (!plans_.torque(t, q, v, tau)) ++counters_.damped;
}

}  // namespace prowl

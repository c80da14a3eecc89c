#include "prowl/online/outside_controller.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "prowl/mpc/standing_robot.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kStands = 0.7;  ///< from the start on, as an MpcController does [s]

bool is_finite_step(const MpcPlan::Step& step) {
  return step.q.allFinite() && step.v.allFinite() && step.a.allFinite() && step.tau.allFinite() &&
         step.gain.allFinite();
}

}  // namespace

OutsideController::OutsideController(const RobotModel& robot, Planner planner, double delay, const VectorXd& q,
                                     double t)
    : OnlineController(robot, delay, q, t, 1, std::numeric_limits<double>::infinity()), planner_(std::move(planner)) {
  timeline_.extend(t, t + kStands);
  // It holds the robot where it stands until another plan acts.
  MpcPlan::Step& first = plans_.begin_next().steps().front();
  first = standing_step(robot_, feet_, q);
  first.start = t;
  first.length = kStands;
}

bool OutsideController::prepare_from(double start) {
  timeline_.extend(start, start + MotionRequest::kPlannedAhead);
  lead_.advance(start);
  return true;
}

bool OutsideController::plan_from(const VectorXd& q, const VectorXd& v, double t) {
  const MotionRequest request{.time = t,
                              .start = start(),
                              .q = q,
                              .v = v,
                              .timeline = timeline_,
                              .command = lead_.followed(),
                              .pose = lead_.pose()};
  const std::optional<double> seconds = planner_(request, steps_);
  computing_time_ = seconds.value_or(0.0);
  if (!seconds || steps_.empty() || !std::ranges::all_of(steps_, is_finite_step)) return false;
  for (MpcPlan::Step& step : steps_) step.standing = timeline_.standing(step.start + 0.5 * step.length);
  plans_.begin_next().steps() = steps_;
  return true;
}

}  // namespace prowl

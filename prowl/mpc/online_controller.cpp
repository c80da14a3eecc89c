#include "prowl/mpc/online_controller.hpp"

#include <cmath>

#include "prowl/mpc/standing_robot.hpp"

namespace prowl {
namespace {

/// Beyond these a measured state is an error. Velocities: of the base over sqrt(g size), all others times
/// sqrt(size / g). Motors are slower by a factor of ten; at much larger ones a prediction is not finite.
constexpr double kFastest = 100.0;
constexpr double kFarthest = 1e6;      ///< [m]: doubles still tell nanometres there
constexpr double kMostTurned = 1e3;    ///< joints [rad]
constexpr double kUnitRounding = 0.1;  ///< of the norm of a quaternion [-]

}  // namespace

using Eigen::VectorXd;

OnlineController::OnlineController(const RobotModel& robot, double delay, const VectorXd& q, double t, int steps,
                                   double most_feedback)
    : robot_(robot),
      feet_(contacts_of_feet(robot)),
      standing_(standing_on_ground(robot)),
      timeline_(static_cast<int>(feet_.size()), t),
      lead_(standing_, q, t),
      plans_(robot_, MpcPlan(robot_, steps, most_feedback)),
      delay_(delay),
      start_(t),
      prediction_(robot_, feet_),
      q_(q),
      v_(VectorXd::Zero(robot.nv())) {}

void OnlineController::follow(const SteppingPattern& pattern) {
  timeline_.follow(pattern);
  lead_.stand(pattern.stands());
}

void OnlineController::feel_contacts(const std::vector<bool>& touches, double t) {
  if (std::isfinite(t)) timeline_.feel(touches, t, delay_);
}

bool OnlineController::prepare(double t) {
  ++counters_.updates;
  if (!std::isfinite(t)) return refuse();
  start_ = t + delay_;
  const bool is_ready = prepare_from(start_);
  if (!is_ready) ++counters_.failed;
  return is_ready;
}

bool OnlineController::plan(const VectorXd& q, const VectorXd& v, double t) {
  if (!std::isfinite(t) || !is_state(q, v)) return refuse();
  q_ = q;
  v_ = v;
  prediction_.predict(plans_, timeline_, t, start_, q_, v_);
  if (!is_state(q_, v_)) return refuse();
  look(q, t);
  lead_.stay_near(q_, robot_.size());
  const bool has_plan = plan_from(q_, v_, t);
  if (!has_plan) ++counters_.failed;
  return has_plan;
}

/// An update without a new plan, as its measured state or time is none.
bool OnlineController::refuse() {
  ++counters_.failed;
  ++counters_.bad_states;
  return false;
}

bool OnlineController::is_state(const VectorXd& q, const VectorXd& v) const {
  const double time = std::sqrt(robot_.size() / RobotModel::kGravity);
  return q.allFinite() && v.allFinite() && q.head<3>().norm() < kFarthest &&
         std::abs(q.segment<4>(3).norm() - 1.0) < kUnitRounding &&
         q.tail(robot_.nu()).cwiseAbs().maxCoeff() < kMostTurned &&
         v.head<3>().norm() < kFastest * robot_.size() / time && v.tail(robot_.nv() - 3).norm() < kFastest / time;
}

void OnlineController::torque(double t, const VectorXd& q, const VectorXd& v, VectorXd& tau) {
  if (!plans_.torque(t, q, v, tau)) ++counters_.damped;
}

}  // namespace prowl

#include "prowl/mpc/online_controller.hpp"

#include "prowl/mpc/standing_robot.hpp"

namespace prowl {

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

bool OnlineController::prepare(double t) {
  ++counters_.updates;
  start_ = t + delay_;
  const bool is_ready = prepare_from(start_);
  if (!is_ready) ++counters_.failed;
  return is_ready;
}

bool OnlineController::plan(const VectorXd& q, const VectorXd& v, double t) {
  if (!q.allFinite() || !v.allFinite()) {
    ++counters_.failed;
    ++counters_.bad_states;
    return false;
  }
  look(q, t);
  q_ = q;
  v_ = v;
  prediction_.predict(plans_, timeline_, t, start_, q_, v_);
  lead_.stay_near(q_, robot_.size());
  const bool has_plan = plan_from(q_, v_, t);
  if (!has_plan) ++counters_.failed;
  return has_plan;
}

void OnlineController::torque(double t, const VectorXd& q, const VectorXd& v, VectorXd& tau) {
  if (!plans_.torque(t, q, v, tau)) ++counters_.damped;
}

}  // namespace prowl

#pragma once

#include "prowl/mpc/mpc_plan.hpp"

namespace prowl {

/// The latest plan of a controller, and the one before it, which acts until the latest does. No function allocates but
/// the constructor.
class LatestPlans {
 public:
  /// `latest`: the first plan.
  LatestPlans(const RobotModel& robot, const MpcPlan& latest);

  const MpcPlan& latest() const { return latest_; }
  /// The place of a new plan, to be written by the caller: it is the latest from now on.
  MpcPlan& begin_next();
  /// Drops the latest plan, which came too late: the one before goes on.
  void drop_latest();
  /// The latest plan was ready at time t [s] only: it acts from then on.
  void act_from(double t) { ready_ = t; }

  /// Torques at time t [s] for the state (q, v) at that time, of the latest plan that has begun, with its gains, within
  /// the limits. After its end torques that damp the joints; then returns false.
  bool torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) const;

 private:
  const RobotModel& robot_;
  MpcPlan latest_, before_;
  double ready_;  ///< time from which the latest may act [s]
};

}  // namespace prowl

#pragma once

#include <vector>

#include "prowl/mpc/mpc_plan.hpp"

namespace prowl {

/// Starts of plans are sums of times: they count as equal within this [s].
inline constexpr double kTimeRounding = 1e-9;

/// The latest plans of a controller: the newest that has begun acts. No function allocates but the constructor.
class LatestPlans {
 public:
  /// A plan begins at most this many periods after its measurement.
  static constexpr int kLongestDelay = 7;

  /// `first`: acts until another begins. The robot must outlive this.
  LatestPlans(const RobotModel& robot, const MpcPlan& first);

  const MpcPlan& latest() const { return kept_.front().plan; }
  /// The place of a new plan, to be written by the caller: it is the latest from now on.
  MpcPlan& begin_next();
  /// The latest plan came too late and never acts: those before go on. It stays the latest until the next begins.
  void drop_latest();
  /// The latest plan becomes ready at time t [s]: it acts from then on.
  void act_from(double t) { kept_.front().ready = t; }

  /// Torques at time t [s] for the state (q, v) at that time, of the newest plan that has begun, with its gains, within
  /// the limits. After its end torques that damp the joints; then returns false.
  bool torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) const;

 private:
  struct Kept {
    MpcPlan plan;
    double ready;  ///< time from which it may act [s]; infinite if it was dropped
  };
  const MpcPlan& acting(double t) const;
  void swap(std::size_t i, std::size_t j);

  const RobotModel& robot_;
  std::vector<Kept> kept_;  ///< the latest first
};

}  // namespace prowl

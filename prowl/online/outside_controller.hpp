#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/online_controller.hpp"

namespace prowl {

/// What a planner is asked: a motion from the state (q, v) on.
struct MotionRequest {
  double time = 0.0;                            ///< of the latest measurement [s]
  double start = 0.0;                           ///< at which the plan begins [s]
  const Eigen::VectorXd &q, &v;                 ///< expected at `start`, from the measured state
  const ContactTimeline& timeline;              ///< contacts, at least for kPlannedAhead
  MpcCommand command;                           ///< after smoothing
  Eigen::Vector3d pose;                         ///< place (x, y) [m] and heading [rad] to which the commands have led
  static constexpr double kPlannedAhead = 2.0;  ///< [s]
};

/// A planner of the user's own. Fills the steps of the plan, whose `standing` are filled for it, and returns its
/// computing time [s]; nothing if it has no plan.
using Planner = std::function<std::optional<double>(const MotionRequest& request, std::vector<MpcPlan::Step>& steps)>;

/// Lets a planner of the user's own control a robot in the place of an MpcController: the same commands, contacts,
/// prediction of the state and choice of plan. Its feedback is limited by the torque limits alone.
class OutsideController final : public OnlineController {
 public:
  /// The robot stands still at q and time t [s]. `delay`: from a measured state to the start of its plan [s].
  OutsideController(const RobotModel& robot, Planner planner, double delay, const Eigen::VectorXd& q, double t);

  double computing_time(double) const override { return computing_time_; }

 private:
  bool prepare_from(double start) override;
  bool plan_from(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) override;

  Planner planner_;
  double computing_time_ = 0.0;  ///< [s]
  std::vector<MpcPlan::Step> steps_;
};

}  // namespace prowl

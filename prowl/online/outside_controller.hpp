#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/online_controller.hpp"
#include "prowl/mpc/standing_robot.hpp"
#include "prowl/mpc/state_prediction.hpp"

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
  /// The robot stands still at (q, v) and time t [s]. `delay`: from a measured state to the start of its plan [s].
  OutsideController(const RobotModel& robot, Planner planner, double delay, const Eigen::VectorXd& q, double t);
  OutsideController(const OutsideController&) = delete;
  OutsideController& operator=(const OutsideController&) = delete;

  const std::vector<std::vector<int>>& feet() const override { return feet_; }
  const ContactTimeline& timeline() const override { return timeline_; }
  const MpcPlan& latest() const override { return plans_.latest(); }
  const MpcCounters& counters() const override { return counters_; }
  const MpcCommand& followed() const override { return lead_.followed(); }

  void follow(const SteppingPattern& pattern) override { timeline_.follow(pattern); }
  MpcCommand command(const MpcCommand& command) override { return lead_.command(command); }
  void feel_contacts(const std::vector<bool>& touches, double t) override;
  bool prepare(double t) override;
  bool plan(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) override;
  double computing_time(double) const override { return computing_time_; }
  void drop_latest() override { plans_.drop_latest(); }
  void act_from(double t) override { plans_.act_from(t); }
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) override;

 private:
  RobotModel robot_;
  Planner planner_;
  double delay_, start_ = 0.0, computing_time_ = 0.0;
  std::vector<std::vector<int>> feet_;
  Eigen::VectorXd standing_, q_, v_;
  ContactTimeline timeline_;
  CommandLead lead_;
  LatestPlans plans_;
  StatePrediction prediction_;
  std::vector<MpcPlan::Step> steps_;
  MpcCounters counters_;
};

}  // namespace prowl

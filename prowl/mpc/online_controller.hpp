#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/command_lead.hpp"
#include "prowl/mpc/contact_timeline.hpp"
#include "prowl/mpc/latest_plans.hpp"
#include "prowl/mpc/state_prediction.hpp"

namespace prowl {

/// Events since the start of a controller.
struct MpcCounters {
  long updates = 0;
  long failed = 0;       ///< updates without a new plan: the last one went on
  long bad_states = 0;   ///< of these: the measured or predicted state was invalid
  long regularised = 0;  ///< updates whose Hessian was not convex
  long restarted = 0;    ///< updates that forgot multipliers, as the one before had failed or was cut short
  long damped = 0;       ///< torques after the end of the last plan: joints are damped
};

/// Plans while its robot moves. update() plans, torque() gives the torques of the plan that acts, with its gains. How a
/// motion is found is left to derived classes; commands, contacts, delay and choice of the plan that acts are here.
class OnlineController {
 public:
  virtual ~OnlineController() = default;
  OnlineController(const OnlineController&) = delete;
  OnlineController& operator=(const OnlineController&) = delete;

  const std::vector<std::vector<int>>& feet() const { return feet_; }  ///< contacts of each foot
  const Eigen::VectorXd& standing_posture() const { return standing_; }
  const ContactTimeline& timeline() const { return timeline_; }
  const MpcPlan& latest() const { return plans_.latest(); }
  const MpcCounters& counters() const { return counters_; }
  /// Command after smoothing, as the latest plan follows it.
  const MpcCommand& followed() const { return lead_.followed(); }

  /// Takes effect after the swings already scheduled. Throws InputError as ContactTimeline::follow().
  virtual void follow(const SteppingPattern& pattern);
  /// Returns the command that is followed: within the speeds that the legs allow, and without velocity while the
  /// pattern stands.
  MpcCommand command(const MpcCommand& command) { return lead_.command(command); }
  /// Which feet touch the ground (one flag a foot), as measured at time t [s]. A foot that touches in the second half
  /// of its swing has landed. Ignored if t is not finite.
  void feel_contacts(const std::vector<bool>& touches, double t);

  /// Plans from the state (q, v) measured at time t [s]. False if there is no new plan: the last one goes on. So it
  /// does after values that are not finite, or that no robot reaches.
  bool update(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) { return prepare(t) && plan(q, v, t); }
  /// The two parts of update(): everything that can be done before the state is measured, and the rest.
  bool prepare(double t);
  bool plan(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t);
  /// Computing time of the latest plan [s], where `on_thread` is the CPU time of the calling thread.
  virtual double computing_time(double on_thread) const { return on_thread; }
  /// The latest plan came too late and never acts: the one before goes on. The next plan starts from it all the same.
  void drop_latest() { plans_.drop_latest(); }
  /// The latest plan becomes ready at time t [s].
  void act_from(double t) { plans_.act_from(t); }

  /// Torques at time t for the state (q, v) at that time: those of the newest plan that has begun, with its gains,
  /// within the limits. After its end, torques that damp the joints.
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau);

 protected:
  /// The robot stands still at q and time t [s]. `delay`: from a measured state to the start of its plan [s].
  /// `steps`, `most_feedback`: of plans, see MpcPlan. Derived classes add the first plan.
  OnlineController(const RobotModel& robot, double delay, const Eigen::VectorXd& q, double t, int steps,
                   double most_feedback);

  /// What can be done before the state is measured, for a plan from `start` [s] on. False if no plan can follow.
  virtual bool prepare_from(double start) = 0;
  /// Learns what the configuration q measured at time t [s] tells of the world.
  virtual void look(const Eigen::VectorXd&, double) {}
  /// Adds a plan from the state (q, v) on, expected at its start; t: of the measured one [s]. False if there is none.
  virtual bool plan_from(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) = 0;

  double start() const { return start_; }  ///< of the plan that is being made [s]

  RobotModel robot_;
  std::vector<std::vector<int>> feet_;
  Eigen::VectorXd standing_;
  ContactTimeline timeline_;
  CommandLead lead_;
  LatestPlans plans_;
  MpcCounters counters_;

 private:
  bool refuse();
  bool is_state(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const;

  double delay_, start_;
  StatePrediction prediction_;
  Eigen::VectorXd q_, v_;  ///< expected at start_
};

}  // namespace prowl

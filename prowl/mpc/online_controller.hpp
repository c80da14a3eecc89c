#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mpc/command_lead.hpp"
#include "prowl/mpc/contact_timeline.hpp"
#include "prowl/mpc/latest_plans.hpp"

namespace prowl {

/// Events since the start of a controller.
struct MpcCounters {
  long updates = 0;
  long failed = 0;       ///< updates without a new plan: the last one went on
  long bad_states = 0;   ///< of these: the measured state was not finite
  long regularised = 0;  ///< updates whose Hessian was not convex
  long restarted = 0;    ///< updates that forgot multipliers, as the one before had failed or was cut short
  long damped = 0;       ///< torques after the end of the last plan: joints are damped
};

/// Plans while its robot moves. update() plans, torque() gives the torques of the latest plan with its gains.
class OnlineController {
 public:
  virtual ~OnlineController() = default;

  virtual const std::vector<std::vector<int>>& feet() const = 0;  ///< contacts of each foot
  virtual const ContactTimeline& timeline() const = 0;
  virtual const MpcPlan& latest() const = 0;
  virtual const MpcCounters& counters() const = 0;
  /// Command after smoothing, as the latest plan follows it.
  virtual const MpcCommand& followed() const = 0;

  /// From the end of what is planned on.
  virtual void follow(const SteppingPattern& pattern) = 0;
  /// Returns the command that is followed: within the speeds that the legs allow.
  virtual MpcCommand command(const MpcCommand& command) = 0;
  /// Which feet touch the ground (one flag a foot), as measured at time t [s]. A foot that touches in the second half
  /// of its swing has landed.
  virtual void feel_contacts(const std::vector<bool>& touches, double t) = 0;

  /// Plans from the state (q, v) measured at time t [s]. False if there is no new plan: the last one goes on.
  bool update(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) { return prepare(t) && plan(q, v, t); }
  /// The two parts of update(): everything that can be done before the state is measured, and the rest.
  virtual bool prepare(double t) = 0;
  virtual bool plan(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) = 0;
  /// Computing time of the latest plan [s], where `on_thread` is the CPU time of the calling thread.
  virtual double computing_time(double on_thread) const { return on_thread; }
  /// Drops the latest plan, which came too late: the one before goes on.
  virtual void drop_latest() = 0;
  /// The latest plan was ready at time t [s] only.
  virtual void act_from(double t) = 0;

  /// Torques at time t for the state (q, v) at that time: those of the latest plan that has begun, with its gains,
  /// within the limits. After its end, torques that damp the joints.
  virtual void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) = 0;
};

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/mpc/command_lead.hpp"
#include "prowl/mpc/contact_timeline.hpp"
#include "prowl/mpc/ground_plane.hpp"
#include "prowl/mpc/horizon_bounds.hpp"
#include "prowl/mpc/horizon_grid.hpp"
#include "prowl/mpc/horizon_program.hpp"
#include "prowl/mpc/horizon_solver.hpp"
#include "prowl/mpc/mpc_options.hpp"
#include "prowl/mpc/mpc_plan.hpp"
#include "prowl/mpc/standing_robot.hpp"

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

/// Whole-body model predictive control of a robot that steps in a pattern on flat ground. update() plans, torque()
/// gives the torques of the latest plan with its gains. After construction nothing is thrown, and nothing allocated but
/// by follow().
class MpcController {
 public:
  /// The robot stands still in its standing posture at (q, v) and time t [s]. Throws InputError if it cannot stand.
  MpcController(const RobotModel& robot, const MpcOptions& options, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                double t);
  MpcController(const MpcController&) = delete;
  MpcController& operator=(const MpcController&) = delete;

  const std::vector<std::vector<int>>& feet() const { return program_.feet(); }
  void follow(const SteppingPattern& pattern);
  /// Returns the command that is followed: within the speeds that the legs allow.
  MpcCommand command(const MpcCommand& command) { return lead_.command(command); }
  /// Drops the latest plan, which came too late: the one before goes on.
  void drop_latest();
  /// Which feet touch the ground (one flag a foot), as measured at time t [s]. A foot that touches in the second half
  /// of its swing has landed.
  void feel_contacts(const std::vector<bool>& touches, double t);

  /// Plans from the state (q, v) measured at time t [s]. False if there is no new plan: the last one goes on.
  bool update(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t);
  /// The two parts of update(): everything that can be done before the state is measured, and the rest.
  bool prepare(double t);
  bool plan(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t);

  /// Torques at time t for the state (q, v) at that time: those of the latest plan that has begun, with its gains,
  /// within the limits. After its end, torques that damp the joints.
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau);

  const MpcPlan& latest() const { return plan_; }
  /// Command after smoothing, as the latest plan follows it.
  const MpcCommand& followed() const { return lead_.followed(); }
  const ContactTimeline& timeline() const { return timeline_; }
  const HorizonSolver& solver() const { return solver_; }
  const MpcCounters& counters() const { return counters_; }
  const Eigen::VectorXd& standing_posture() const { return program_.standing_posture(); }

 private:
  void lay_horizon(double start);
  void shift();
  void predict(Eigen::VectorXd& q, Eigen::VectorXd& v, double from, double to);
  void restart();
  void read_plan();
  void find_ground(const Eigen::VectorXd& q, double t);
  unsigned standing_at(double t) const;

  RobotModel robot_;
  MpcOptions options_;
  HorizonProgram program_;
  HorizonSolver solver_;
  ContactTimeline timeline_;
  HorizonGrid grid_;
  MpcPlan plan_, previous_;
  int failed_in_a_row_ = 0;
  bool is_settled_ = true;  ///< the latest update took its whole step
  MpcCounters counters_;
  std::vector<std::unique_ptr<ForwardDynamics>> dynamics_;  ///< by the bits of standing feet
  RigidBodyTerms terms_;
  GroundPlane ground_;
  CommandLead lead_;
  HorizonBounds bounds_;
  double horizon_start_ = 0.0;
  std::vector<BarrierRows> old_rows_;
  std::vector<StageMultipliers> old_multipliers_;
  std::vector<double> old_lengths_;
  Eigen::VectorXd q_, v_, a_, tau_, q_next_, v_next_;
};

}  // namespace prowl

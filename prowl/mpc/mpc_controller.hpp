#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mpc/ground_plane.hpp"
#include "prowl/mpc/horizon_bounds.hpp"
#include "prowl/mpc/horizon_grid.hpp"
#include "prowl/mpc/horizon_program.hpp"
#include "prowl/mpc/horizon_solver.hpp"
#include "prowl/mpc/mpc_options.hpp"
#include "prowl/mpc/online_controller.hpp"
#include "prowl/mpc/standing_robot.hpp"
#include "prowl/mpc/state_prediction.hpp"

namespace prowl {

/// Whole-body model predictive control of a robot that steps in a pattern on flat ground. After construction nothing is
/// thrown or allocated but by follow().
class MpcController final : public OnlineController {
 public:
  /// The robot stands still in its standing posture at (q, v) and time t [s]. Throws InputError if it cannot stand, and
  /// for options out of range.
  MpcController(const RobotModel& robot, const MpcOptions& options, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                double t);
  MpcController(const MpcController&) = delete;
  MpcController& operator=(const MpcController&) = delete;

  const std::vector<std::vector<int>>& feet() const override { return program_.feet(); }
  const ContactTimeline& timeline() const override { return timeline_; }
  const MpcPlan& latest() const override { return plans_.latest(); }
  const MpcCounters& counters() const override { return counters_; }
  const MpcCommand& followed() const override { return lead_.followed(); }
  const HorizonSolver& solver() const { return solver_; }
  const Eigen::VectorXd& standing_posture() const { return program_.standing_posture(); }

  void follow(const SteppingPattern& pattern) override;
  MpcCommand command(const MpcCommand& command) override { return lead_.command(command); }
  void feel_contacts(const std::vector<bool>& touches, double t) override;
  bool prepare(double t) override;
  bool plan(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) override;
  void drop_latest() override { plans_.drop_latest(); }
  void act_from(double t) override { plans_.act_from(t); }
  void torque(double t, const Eigen::VectorXd& q, const Eigen::VectorXd& v, Eigen::VectorXd& tau) override;

 private:
  void lay_horizon(double start);
  void shift();
  void restart();
  void read_plan();
  void find_ground(const Eigen::VectorXd& q, double t);

  RobotModel robot_;
  MpcOptions options_;
  HorizonProgram program_;
  HorizonSolver solver_;
  ContactTimeline timeline_;
  HorizonGrid grid_;
  LatestPlans plans_;
  StatePrediction prediction_;
  int failed_in_a_row_ = 0;
  bool is_settled_ = true;  ///< the latest update took its whole step
  MpcCounters counters_;
  RigidBodyTerms terms_;
  GroundPlane ground_;
  CommandLead lead_;
  HorizonBounds bounds_;
  double horizon_start_ = 0.0, ground_seen_ = 0.0;  ///< [s]
  std::vector<BarrierRows> old_rows_;
  std::vector<StageMultipliers> old_multipliers_;
  std::vector<double> old_lengths_;
  Eigen::VectorXd q_, v_, a_, tau_, q_next_, v_next_;
};

}  // namespace prowl

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

namespace prowl {

/// Whole-body model predictive control of a robot that steps in a pattern on flat ground. After construction nothing is
/// thrown or allocated but by follow().
class MpcController final : public OnlineController {
 public:
  /// The robot stands still in its standing posture at (q, v) and time t [s]. Throws InputError if it cannot stand, and
  /// for options out of range.
  MpcController(const RobotModel& robot, const MpcOptions& options, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                double t);

  const HorizonSolver& solver() const { return solver_; }
  void follow(const SteppingPattern& pattern) override;

 private:
  void shift();
  void restart();
  bool is_lost() const;
  void begin_anew();
  void read_plan();
  bool prepare_from(double start) override;
  void look(const Eigen::VectorXd& q, double t) override;  ///< at the ground
  bool plan_from(const Eigen::VectorXd& q, const Eigen::VectorXd& v, double t) override;

  MpcOptions options_;
  HorizonProgram program_;
  HorizonSolver solver_;
  HorizonGrid grid_;
  int failed_in_a_row_ = 0;
  Eigen::VectorXd failed_at_;      ///< configuration of the robot at the latest failure
  Eigen::VectorXd still_torques_;  ///< of the standing posture
  bool is_settled_ = true;         ///< if not, the next update starts anew
  RigidBodyTerms terms_;
  GroundPlane ground_;
  HorizonBounds bounds_;
  double ground_seen_ = 0.0;  ///< [s]
  std::vector<BarrierRows> old_rows_;
  std::vector<StageMultipliers> old_multipliers_;
  std::vector<double> old_times_;  ///< of the nodes to which these belong [s]
  Eigen::VectorXd q_, v_, a_, tau_, q_next_, v_next_;
};

}  // namespace prowl

#pragma once

#include "prowl/model/robot_model.hpp"
#include "prowl/mpc/mpc_weights.hpp"
#include "prowl/transcription/node/node_functions.hpp"

namespace prowl {

struct MpcOptions {
  MpcWeights weights;
  double friction = 0.6;       ///< coefficient of the ground that plans may use [-]
  int steps = 20;              ///< of the horizon
  int steps_of_biped = 12;     ///< the same for a robot on two feet: Talos holds as well as with 20, in 0.7 of the time
  double first_step = 0.015;   ///< [s]; the delay if that is longer
  double least_horizon = 0.6;  ///< [s]; a stride if that is longer
  double clearance = 0.12;     ///< height of a swing, as a share of the robot's standing height [-]
  /// The same for a robot on two feet. With 0.12, Talos falls in two of six runs in which it steps for ten seconds.
  double clearance_of_biped = 0.05;
  /// From a measured state to the time at which its plan acts [s], at most LatestPlans::kLongestDelay updates later.
  double delay = 0.0;
  double barrier = 1e-5;  ///< mu, of a step of mean length [-]
  int iterations = 10;    ///< maximum of an update before the state is measured
  /// And after. With kicks of 1.0 m/s, HyQ and Go2 fall with 1. With 2, 3 and 5 they do not, but 43, 4 and 0 of 6,000
  /// plans of HyQ fail; p99 of this phase is 0.6, 1.1 and 1.1 ms.
  int feedback_iterations = 5;
  HessianKind hessian = HessianKind::gauss_newton_with_cones;
};

/// The same options; throws InputError for one out of range.
const MpcOptions& checked(const MpcOptions& options);

/// Checked, with the values of a biped if it is one, and a first step no shorter than the delay: what is measured
/// cannot change the motion before.
MpcOptions options_for(const RobotModel& robot, const MpcOptions& options);

}  // namespace prowl

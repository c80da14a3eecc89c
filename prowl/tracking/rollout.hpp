#pragma once

#include <Eigen/Core>
#include <functional>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {

/// One instant of a rollout.
struct RolloutSample {
  double time = 0.0;
  Eigen::VectorXd q, v, tau;
  Eigen::VectorXd force;  ///< 3 per contact of the ROBOT, world frame [N]; zero in the air
  int segment = 0;        ///< index in the tracking plan
};

struct RolloutOptions {
  bool closed_loop = true;    ///< false: feedforward only
  double stand_on = 0.0;      ///< simulated time after the end of the plan [s]
  double control_step = 0.0;  ///< > 0: period of a controller that holds torques [s]; 0: continuous control
  double sample_step = 0.01;  ///< > 0, of the recorded samples [s]
  double tolerance = 1e-8;    ///< of the integrator, absolute and relative
};

struct Rollout {
  std::vector<RolloutSample> samples;  ///< from the start to the end or the last before a fall
  bool fell = false;                   ///< too far from the reference, see rollout()
  double end_time = 0.0;               ///< of the end or the fall [s]
};

/// Integrates the projected dynamics forward from (q, v) at the start of a tracking plan
/// (Dormand-Prince 5(4), adaptive, Boost.Odeint; orientations in a chart about the last state).
/// Contacts follow the schedule, and may pull; when one closes, velocity_after_landing() changes
/// the velocity. This is the design model of the gains, not an independent check: that is the
/// simulation. Joint limits are ignored. Ends early, with `fell`, by has_fallen() or if the
/// dynamics are not finite. `on_time(t, end)` [s] reports progress; it may be empty.
Rollout rollout(const RobotModel& robot, const Tracker& tracker, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                const RolloutOptions& options, const std::function<void(double t, double end)>& on_time = {});

}  // namespace prowl

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
  Eigen::VectorXd force;  ///< 3 per contact of the ROBOT, world frame [N]; zero where the schedule has none
  int segment = 0;        ///< of the tracking plan
};

struct RolloutOptions {
  bool closed_loop = true;    ///< false: the planned torques alone
  double stand_on = 0.0;      ///< goes on for so long after the end of the plan [s]
  double control_step = 0.0;  ///< > 0: torque held between the ticks of a controller [s]; 0: always that of the moment
  double sample_step = 0.01;  ///< > 0, of what is kept [s]
  double tolerance = 1e-8;    ///< of the integrator, absolute and relative
};

struct Rollout {
  std::vector<RolloutSample> samples;  ///< from the start on; the last is the end, or the last before it fell
  bool fell = false;                   ///< it came so far from the reference that going on means nothing, see rollout()
  double end_time = 0.0;               ///< when it ended, or fell [s]
};

/// Integrates the projected dynamics forward from (q, v) at the start of a tracking plan (Dormand-Prince 5(4),
/// adaptive, Boost.Odeint; orientations in a chart about the last state). The contacts are those of the schedule, at
/// their times: they pull too, and where one closes the velocity changes by velocity_after_landing(). So this is the
/// model that the gains were made for, not a judge: that is the simulation. Joints turn beyond their limits. Ends
/// early, fell, by has_fallen(), or when the dynamics are no longer finite. `on_time(t, end)` is called as it goes on
/// [s]; it may be empty.
Rollout rollout(const RobotModel& robot, const Tracker& tracker, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                const RolloutOptions& options, const std::function<void(double t, double end)>& on_time = {});

}  // namespace prowl

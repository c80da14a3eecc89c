#pragma once

#include <set>
#include <string>

#include "prowl/model/surface.hpp"
#include "prowl/online/force_check.hpp"
#include "prowl/online/online_result.hpp"
#include "prowl/simulation/physics.hpp"

namespace prowl {

/// Judges a run under online control while it goes on.
class OnlineMeasures {
 public:
  /// `duration` [s] and the height at which the robot stands [m]; the others as in ForceCheck.
  OnlineMeasures(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double friction, double duration,
                 double standing_height);

  /// The true state at time t [s], the command that is followed, and the ground. Returns false if the robot has fallen.
  bool add_state(double t, const Physics& physics, const MpcCommand& command, const Surface& ground);
  /// A new plan, whose first `period` seconds are executed; `pushed`: during a push or soon after.
  void add_plan(const MpcPlan& plan, double period, bool pushed);
  void add_touch(const std::string& touch) { touches_.insert(touch); }
  static OnlineSample sample(double t, const Physics& physics, const MpcCommand& command);

  /// Completes a result with how it ended.
  void finish(OnlineResult& result) const;

 private:
  double duration_, standing_height_;
  ForceCheck forces_;
  ForceCount undisturbed_, kicked_;
  double velocity_squares_ = 0.0, turn_squares_ = 0.0;
  Eigen::Vector2d last_off_ = Eigen::Vector2d::Zero();
  long measured_ = 0, last_count_ = 0;
  std::set<std::string> touches_;
};

}  // namespace prowl

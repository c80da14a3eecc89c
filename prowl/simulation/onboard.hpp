#pragma once

#include <optional>

#include "prowl/estimation/base_estimator.hpp"
#include "prowl/estimation/joint_filter.hpp"
#include "prowl/motion/motion_problem.hpp"
#include "prowl/simulation/sensors.hpp"
#include "prowl/tracker/tracker.hpp"

namespace prowl {

/// What runs on the robot: from sensor readings to the state and to torques. Knows the plan, the robot as modelled, how noisy
/// its sensors are, and nothing of the truth unless it is told.
class Onboard {
 public:
  Onboard(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options);

  /// Takes the reading at time t, `dt` after the one before.
  void sense(double t, double dt, const SensorReading& reading);
  /// In place of sense(): the true state.
  void be_told(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }

 private:
  Eigen::VectorXd planned_joint_acceleration(double from, double to) const;

  const MotionProblem& problem_;
  const Tracker& tracker_;
  JointFilter joints_;
  BaseEstimator base_;
  std::vector<std::vector<Eigen::Vector3d>> normals_;  ///< of each phase, one a contact
  Eigen::VectorXd q_, v_;
};

}  // namespace prowl

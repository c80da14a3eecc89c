#pragma once

#include <map>
#include <memory>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/estimation/base_estimator.hpp"
#include "prowl/estimation/joint_filter.hpp"

namespace prowl {

struct SensorReading {
  Eigen::VectorXd encoders;       ///< nu [rad]
  Eigen::Vector3d gyro;           ///< base frame, mean since the last reading [rad/s]
  Eigen::Vector3d accelerometer;  ///< specific force, base frame, mean since the last reading [m/s^2]: +9.81 up at rest
};

/// Standing contacts of the robot, and the ground under them.
struct Stand {
  std::vector<bool> in_contact;          ///< one per contact of the robot
  std::vector<Eigen::Vector3d> normals;  ///< of the surface under each contact, unit vectors, world frame
};

/// State of the whole robot from its sensors: base by BaseEstimator, joints by JointFilter with the model's
/// accelerations from the commanded torques. Without the model the filter would lag behind the feedback, and with the
/// delay of the torques swing legs would shake.
class StateEstimator {
 public:
  /// Starts near the state (q, v), as `noise` tells. `joint_density` [rad²/s³]: noise density S of JointFilter.
  StateEstimator(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Stand& stand,
                 const EstimatorNoise& noise, double joint_density);

  /// Advances by dt [s]. `tau` (nu): commanded joint torques over that time.
  void update(double dt, const SensorReading& reading, const Eigen::VectorXd& tau, const Stand& stand);
  /// Sets the state directly, in place of an estimate.
  void set(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  const Eigen::VectorXd& q() const { return q_; }  ///< nq
  const Eigen::VectorXd& v() const { return v_; }  ///< nv
  const BaseEstimator& base() const { return base_; }

  /// Advances (q, v) by dt [s] under the torques tau, by the model.
  void predict(double dt, const Eigen::VectorXd& tau, const Stand& stand, Eigen::VectorXd& q, Eigen::VectorXd& v);

 private:
  Eigen::VectorXd acceleration(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau,
                               const Stand& stand);
  bool has_plausible_rates(const Eigen::VectorXd& v) const;

  const RobotModel& robot_;
  JointFilter joints_;
  BaseEstimator base_;
  std::map<std::vector<bool>, std::unique_ptr<ForwardDynamics>> dynamics_;  ///< one per set of contacts so far
  Eigen::VectorXd q_, v_;
};

}  // namespace prowl

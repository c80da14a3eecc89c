#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <vector>

#include "prowl/model/leg_kinematics.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// The filter's assumptions on the sensors: standard deviations of one sample.
struct EstimatorNoise {
  double encoder = 1e-3;             ///< [rad]
  double gyro = 2e-3;                ///< [rad/s]
  double accelerometer = 0.05;       ///< [m/s^2]
  double gyro_bias = 2e-3;           ///< of the constant bias at the start [rad/s]
  double accelerometer_bias = 0.05;  ///< the same [m/s^2]
  /// Wander of a foot on the ground: white noise on its velocity [m/sqrt(s)].
  double foot = 2e-3;
  /// The same in the first `landing` seconds after its scheduled landing: it may be late.
  double landing_foot = 0.1;
  double landing = 0.03;  ///< [s]
  // Of the start: the plan is laid over the feet, on ground that is not quite level, and the base is somewhere above.
  double start_foothold = 2e-3;   ///< across [m]
  double start_ground = 0.01;     ///< up [m]
  double start_position = 0.01;   ///< of the base [m]
  double start_angle = 0.02;      ///< [rad]
  double start_velocity = 0.05;   ///< [m/s]
  double start_joint = 0.05;      ///< [rad]
  double start_joint_rate = 0.3;  ///< [rad/s]
};

/// Position, velocity and orientation of the base from an IMU at its origin and the standing legs: an error-state
/// Kalman filter after Bloesch et al., "State estimation for legged robots: consistent fusion of leg kinematics and
/// IMU", RSS 2012, with the biases of the IMU and the positions c_i of the standing feet in the state.
///
///   p' = v,  v' = R (f - b_f) + g,  R' = R [ω - b_ω]×,  c_i' = rolling + w_i
///   measured:  s_i(joints) = R' (c_i - p) + n_i
///
/// f and ω are means over the time between samples. The error of R is a rotation vector in the base frame: R = R̂
/// exp(δθ). c_i is the centre of the foot's ball, which moves as the ball rolls. No sensor observes the position and
/// yaw of the base in the world: their errors grow with each step. A foot whose measurement is off by more than its
/// noise is left out; if it stays off, it gets a new position.
class BaseEstimator {
 public:
  /// Starts near the state (q, v), with `in_contact` (one per contact of the robot) on the ground.
  BaseEstimator(const RobotModel& robot, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                const std::vector<bool>& in_contact, const EstimatorNoise& noise);

  /// Advances by dt [s] with the IMU's means over that time, then corrects with the encoders. `joint_rates` [rad/s]
  /// determine how feet roll on ground with these normals (one per contact, unit vectors, world frame).
  void update(double dt, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accelerometer,
              const Eigen::VectorXd& encoders, const Eigen::VectorXd& joint_rates, const std::vector<bool>& in_contact,
              const std::vector<Eigen::Vector3d>& normals);

  const Eigen::Vector3d& position() const { return position_; }                  ///< world frame [m]
  const Eigen::Vector3d& velocity() const { return velocity_; }                  ///< world frame [m/s]
  const Eigen::Matrix3d& rotation() const { return rotation_; }                  ///< base to world
  const Eigen::Vector3d& angular_velocity() const { return angular_velocity_; }  ///< base frame [rad/s], without bias
  const Eigen::Vector3d& gyro_bias() const { return gyro_bias_; }
  const Eigen::Vector3d& accelerometer_bias() const { return accelerometer_bias_; }
  /// For the errors of (p, v, δθ, b_f, b_ω, c_0, c_1, ...); blocks of feet in the air are zero.
  const Eigen::MatrixXd& covariance() const { return covariance_; }

 private:
  struct Foot {
    bool stands = false;
    double since = 0.0;   ///< [s]
    int rejected = 0;     ///< measurements in a row
    double radius = 0.0;  ///< [m]
    Eigen::Vector3d foothold = Eigen::Vector3d::Zero();
  };

  void predict(double dt, const Eigen::Vector3d& gyro, const Eigen::Vector3d& accelerometer,
               const Eigen::VectorXd& joint_rates, const std::vector<Eigen::Vector3d>& normals);
  void put_down(int contact);
  void lift(int contact);
  void correct();
  void apply(const Eigen::VectorXd& error);

  EstimatorNoise noise_;
  LegKinematics legs_;
  Eigen::Vector3d position_, velocity_;
  Eigen::Matrix3d rotation_;
  Eigen::Vector3d angular_velocity_;
  Eigen::Vector3d gyro_bias_ = Eigen::Vector3d::Zero(), accelerometer_bias_ = Eigen::Vector3d::Zero();
  std::vector<Foot> feet_;
  Eigen::MatrixXd covariance_;
};

}  // namespace prowl

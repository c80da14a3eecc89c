#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "prowl/model/configuration.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl::test {

/// Random configurations, velocities and torques of one robot; the same sequence for the same seed.
class RandomStates {
 public:
  /// Joints are drawn from their limits, but no further than `window` [rad] from the nominal posture: limits may be
  /// useless (ANYmal C's are +-9.42 rad).
  RandomStates(const RobotModel& robot, unsigned seed, double window = std::numbers::pi)
      : robot_(robot), random_(seed), window_(window) {}

  Eigen::VectorXd configuration() {
    Eigen::VectorXd q = robot_.nominal_configuration();
    for (int i = 0; i < 3; ++i) q(i) = uniform(-1.0, 1.0);
    set_base_rotation(q, Eigen::Quaterniond(Eigen::Vector4d(vector(4))).normalized().toRotationMatrix());
    for (int j = 0; j < robot_.nu(); ++j) {
      const double nominal = q(7 + j);
      q(7 + j) = uniform(std::max(robot_.position_lower()(j), nominal - window_),
                         std::min(robot_.position_upper()(j), nominal + window_));
    }
    return q;
  }

  /// Up to 1 m/s, 1 rad/s of the base, 3 rad/s of the joints.
  Eigen::VectorXd velocity() {
    Eigen::VectorXd v = vector(robot_.nv());
    v.tail(robot_.nu()) *= 3.0;
    return v;
  }

  /// Up to the torque limits, 100 N m where there is none.
  Eigen::VectorXd torque() { return vector(robot_.nu()).cwiseProduct(robot_.torque_limit().cwiseMin(100.0)); }

  /// Entries in [-1, 1].
  Eigen::VectorXd vector(Eigen::Index size) {
    return Eigen::VectorXd::NullaryExpr(size, [this] { return uniform(-1.0, 1.0); });
  }

 private:
  double uniform(double lower, double upper) { return std::uniform_real_distribution(lower, upper)(random_); }

  const RobotModel& robot_;
  std::mt19937 random_;
  double window_;
};

}  // namespace prowl::test

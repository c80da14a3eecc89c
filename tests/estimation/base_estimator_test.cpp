#include "prowl/estimation/base_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

constexpr double kStep = 1e-3;

/// HyQ on feet without a radius, so that they stay where they are, its base swaying and turning over them.
class Sway {
 public:
  Sway() : robot_(description()) {
    LegKinematics legs(robot_);
    const Eigen::VectorXd& q = robot_.nominal_configuration();
    for (int c = 0; c < 4; ++c) targets_.push_back({c, q.head<3>() + base_rotation(q) * legs.position(c)});
    // IMU by differences of the motion itself: velocities at steps, means between them.
    q_.push_back(posture(0.0));
    for (int i = 1; i <= kSteps; ++i) q_.push_back(posture(i * kStep));
  }

  static constexpr int kSteps = 2000;
  const RobotModel& robot() const { return robot_; }
  const Eigen::VectorXd& q(int i) const { return q_[i]; }
  Eigen::Vector3d velocity(int i) const {
    const double t = i * kStep, s = M_PI * std::sin(2.0 * M_PI * t);  // of 0.5 (1 - cos), that is of sway()
    return s * kWay;
  }
  Eigen::Vector3d gyro(int i) const {  // mean from i - 1 to i
    return so3::log(base_rotation(q(i - 1)).transpose() * base_rotation(q(i))) / kStep;
  }
  Eigen::Vector3d accelerometer(int i) const {
    const Eigen::Vector3d a = (velocity(i) - velocity(i - 1)) / kStep + Eigen::Vector3d(0, 0, RobotModel::kGravity);
    const Eigen::Matrix3d middle = base_rotation(q(i - 1)) * so3::exp(0.5 * kStep * gyro(i));
    return middle.transpose() * a;
  }

 private:
  static inline const Eigen::Vector3d kWay{0.05, -0.03, -0.06}, kTurn{0.1, -0.08, 0.12};
  static RobotDescription description() {
    RobotDescription robot = test::hyq_description();
    for (ContactPoint& contact : robot.contacts) contact.radius = 0.0;
    return robot;
  }
  static double sway(double t) { return 0.5 * (1.0 - std::cos(2.0 * M_PI * t)); }
  Eigen::VectorXd posture(double t) {
    Eigen::VectorXd q = q_.empty() ? robot_.nominal_configuration() : q_.back();
    q.head<3>() = robot_.nominal_configuration().head<3>() + sway(t) * kWay;
    set_base_rotation(q, base_rotation(robot_.nominal_configuration()) * so3::exp(sway(t) * kTurn));
    return inverse_kinematics(robot_, q, targets_).q;
  }

  RobotModel robot_;
  std::vector<ContactTarget> targets_;
  std::vector<Eigen::VectorXd> q_;
};

const Sway& sway() {
  static const Sway motion;
  return motion;
}

/// The start is known, to rounding.
EstimatorNoise known_start() {
  EstimatorNoise noise;
  for (double* start :
       {&noise.start_position, &noise.start_angle, &noise.start_velocity, &noise.start_foothold, &noise.start_ground})
    *start = 1e-5;
  return noise;
}

/// Runs the filter over the motion with sensors as noisy as `noise` says, times `scale`. It is told that the motion
/// starts where it is at step `begin`.
BaseEstimator run(const EstimatorNoise& noise, double scale, unsigned seed, const std::vector<bool>& in_contact,
                  int begin = 0) {
  const Sway& motion = sway();
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal(0.0, scale);
  const auto draw = [&](Eigen::Index size, double deviation) {
    return Eigen::VectorXd::NullaryExpr(size, [&] { return deviation * normal(random); }).eval();
  };
  const Eigen::Vector3d gyro_bias = draw(3, noise.gyro_bias), bias = draw(3, noise.accelerometer_bias);
  const std::vector<Eigen::Vector3d> up(4, Eigen::Vector3d::UnitZ());
  BaseEstimator estimator(motion.robot(), motion.q(begin), Eigen::VectorXd::Zero(18), in_contact, noise);
  for (int i = 1; i <= Sway::kSteps; ++i) {
    estimator.update(kStep, motion.gyro(i) + gyro_bias + draw(3, noise.gyro),
                     motion.accelerometer(i) + bias + draw(3, noise.accelerometer),
                     motion.q(i).tail(12) + draw(12, noise.encoder), Eigen::VectorXd::Zero(12), in_contact, up);
  }
  return estimator;
}

/// Estimated minus true: position, velocity, rotation vector.
Eigen::Matrix<double, 9, 1> error(const BaseEstimator& estimator) {
  const Eigen::VectorXd& q = sway().q(Sway::kSteps);
  Eigen::Matrix<double, 9, 1> e;
  e << base_position(q) - estimator.position(), sway().velocity(Sway::kSteps) - estimator.velocity(),
      so3::log(estimator.rotation().transpose() * base_rotation(q));
  return e;
}

const std::vector<bool> kAll(4, true);

TEST(BaseEstimator, ReturnsTheTruthWithoutNoise) {
  const Eigen::Matrix<double, 9, 1> e = error(run(known_start(), 0.0, 1, kAll));
  EXPECT_LT(e.head<3>().norm(), 1e-5);
  EXPECT_LT(e.segment<3>(3).norm(), 1e-4);
  EXPECT_LT(e.tail<3>().norm(), 1e-5);
}

TEST(BaseEstimator, StaysNearTheTruthWithNoise) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Eigen::Matrix<double, 9, 1> e = error(run(known_start(), 1.0, seed, kAll));
    EXPECT_LT(e.head<3>().norm(), 3e-3) << "m";
    EXPECT_LT(e.segment<3>(3).norm(), 0.02) << "m/s";
    EXPECT_LT(e.tail<3>().norm(), 5e-3) << "rad";
    EXPECT_GT(e.norm(), 1e-6) << "there was no noise";
  }
}

/// Told that its base is elsewhere over the same feet, it finds it; believing what it is told, it does not.
TEST(BaseEstimator, FindsTheBaseOverItsFeet) {
  constexpr int kElsewhere = 120;
  const double off = (base_position(sway().q(kElsewhere)) - base_position(sway().q(0))).norm();
  ASSERT_GT(off, 8e-3) << "the test does not test much";
  for (unsigned seed = 1; seed <= 10; ++seed) {
    const Eigen::Matrix<double, 9, 1> e = error(run({}, 1.0, seed, kAll, kElsewhere));
    EXPECT_LT(e.head<3>().norm(), 0.6 * off) << "m";
    EXPECT_LT(e.segment<3>(3).norm(), 0.02) << "m/s";
    EXPECT_LT(e.tail<3>().norm(), 0.01) << "rad: accelerometers with a bias of 0.05 m/s² see no 5e-3";
  }
  EXPECT_GT(error(run(known_start(), 1.0, 1, kAll, kElsewhere)).head<3>().norm(), 0.5 * off);
}

/// Two feet carry it too, and legs are what does it: integrating the IMU alone runs away.
TEST(BaseEstimator, NeedsFeet) {
  double two = 0.0, none = 0.0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    two = std::max(two, error(run(known_start(), 1.0, seed, {true, false, false, true})).head<3>().norm());
    none = std::max(none, error(run(known_start(), 1.0, seed, std::vector<bool>(4, false))).head<3>().norm());
  }
  EXPECT_LT(two, 5e-3);
  EXPECT_GT(none, 0.05);
}

/// The error is as large as the covariance says: e' P⁻¹ e over runs has the mean of its dimension. The noise of
/// standing feet, that is none here, makes the filter a little more careful than it needs to be.
TEST(BaseEstimator, KnowsHowGoodItIs) {
  EstimatorNoise noise = known_start();
  noise.foot = 1e-4;
  double sum = 0.0;
  const int runs = 30;
  for (unsigned seed = 1; seed <= runs; ++seed) {
    const BaseEstimator estimator = run(noise, 1.0, seed, kAll);
    const Eigen::Matrix<double, 9, 1> e = error(estimator);
    const Eigen::Matrix<double, 9, 9> P = estimator.covariance().topLeftCorner<9, 9>();
    sum += e.dot(P.ldlt().solve(e)) / 9.0;
  }
  EXPECT_GT(sum / runs, 0.4);
  EXPECT_LT(sum / runs, 1.5);
}

}  // namespace
}  // namespace prowl

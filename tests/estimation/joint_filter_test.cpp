#include "prowl/estimation/joint_filter.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace prowl {
namespace {

constexpr double kStep = 1e-3;

struct Errors {
  double position = 0.0, rate = 0.0;  // RMS
};

/// Follows a joint that swings by 0.5 rad once a second, told its acceleration or not.
Errors follow(double noise, bool told, double density, double real_noise) {
  std::mt19937_64 random(3);
  std::normal_distribution<double> normal(0.0, 1.0);
  const double w = 2.0 * M_PI;
  const auto q = [&](double t) { return 0.5 * (1.0 - std::cos(w * t)); };
  JointFilter filter(Eigen::VectorXd::Constant(1, q(0.0)), Eigen::VectorXd::Zero(1), noise, density);
  Errors squares;
  const int count = 2000;
  for (int i = 1; i <= count; ++i) {
    const double t = i * kStep, before = t - 0.5 * kStep;
    const Eigen::VectorXd a = Eigen::VectorXd::Constant(1, told ? 0.5 * w * w * std::cos(w * before) : 0.0);
    filter.update(kStep, a, Eigen::VectorXd::Constant(1, q(t) + real_noise * normal(random)));
    squares.position += std::pow(filter.positions()(0) - q(t), 2) / count;
    squares.rate += std::pow(filter.rates()(0) - 0.5 * w * std::sin(w * t), 2) / count;
  }
  return {std::sqrt(squares.position), std::sqrt(squares.rate)};
}

TEST(JointFilter, IsExactWithoutNoise) {
  const Errors errors = follow(1e-5, true, 1.0, 0.0);
  EXPECT_LT(errors.position, 1e-7);
  EXPECT_LT(errors.rate, 1e-5);
}

TEST(JointFilter, SeesRatesThatDifferencesOfSamplesDoNot) {
  const Errors errors = follow(1e-3, true, 1.0, 1e-3);
  EXPECT_LT(errors.position, 1e-3) << "worse than the encoder";
  EXPECT_LT(errors.rate, 0.15) << "differences of samples are 1.4 rad/s off";
}

TEST(JointFilter, NeedsTheAcceleration) {
  // With a small density the filter believes its model: it lags if the model does not know the acceleration.
  EXPECT_LT(follow(1e-3, true, 1e-3, 1e-3).rate, 0.02);
  EXPECT_GT(follow(1e-3, false, 1e-3, 1e-3).rate, 0.2);
}

/// The errors are as large as the filter says: over many runs, squared error over variance is one on average.
TEST(JointFilter, KnowsHowGoodItIs) {
  std::mt19937_64 random(5);
  std::normal_distribution<double> normal(0.0, 1.0);
  const double density = 0.5, noise = 1e-3;
  double position = 0.0, rate = 0.0;
  const int joints = 2000;
  Eigen::VectorXd q = Eigen::VectorXd::Zero(joints), v = Eigen::VectorXd::Zero(joints);
  JointFilter filter(q, v, noise, density);
  for (int i = 0; i < 200; ++i) {
    for (int j = 0; j < joints; ++j) {
      // White noise on the acceleration, integrated exactly over a step.
      const double a = normal(random), b = normal(random), root = std::sqrt(density * kStep);
      q(j) += kStep * v(j) + root * kStep * (0.5 * a + b / std::sqrt(12.0));
      v(j) += root * a;
    }
    filter.update(kStep, Eigen::VectorXd::Zero(joints),
                  q + Eigen::VectorXd::NullaryExpr(joints, [&] { return noise * normal(random); }));
  }
  position = (filter.positions() - q).squaredNorm() / joints / filter.covariance()(0, 0);
  rate = (filter.rates() - v).squaredNorm() / joints / filter.covariance()(1, 1);
  EXPECT_NEAR(position, 1.0, 0.1);
  EXPECT_NEAR(rate, 1.0, 0.1);
}

}  // namespace
}  // namespace prowl

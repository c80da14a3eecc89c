#include "prowl/estimation/state_estimator.hpp"

#include <gtest/gtest.h>

#include <random>

#include "prowl/dynamics/static_equilibrium.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

constexpr double kStep = 1e-3;

/// HyQ stands still; its encoders do not always say so.
class StateEstimatorTest : public ::testing::Test {
 protected:
  Stand stand_{std::vector<bool>(4, true), std::vector<Eigen::Vector3d>(4, Eigen::Vector3d::UnitZ())};
  RobotModel robot_ = test::hyq();
  Eigen::VectorXd q_ = robot_.nominal_configuration();
  Eigen::VectorXd tau_ = static_equilibrium(robot_, q_, {0, 1, 2, 3}).tau;
  StateEstimator estimator_{robot_, q_, Eigen::VectorXd::Zero(robot_.nv()), stand_, EstimatorNoise{}, 1.0};

  void update(const Eigen::VectorXd& encoders) {
    estimator_.update(kStep, {encoders, Eigen::Vector3d::Zero(), RobotModel::kGravity * Eigen::Vector3d::UnitZ()}, tau_,
                      stand_);
  }
};

TEST_F(StateEstimatorTest, StaysWhereTheRobotStands) {
  for (int i = 0; i < 500; ++i) update(q_.tail(robot_.nu()));
  EXPECT_LT((estimator_.q() - q_).norm(), 1e-3);
  EXPECT_LT(estimator_.v().norm(), 1e-2);
}

/// The model's accelerations are quadratic in the estimated rates: without a bound these run away from any encoder.
TEST_F(StateEstimatorTest, ComesBackFromABlow) {
  std::mt19937 random(1);
  for (int i = 0; i < 100; ++i) {
    const auto blow = Eigen::VectorXd::NullaryExpr(robot_.nu(), [&] { return 1.0 * random() / 4294967295.0 - 0.5; });
    update(q_.tail(robot_.nu()) + blow.eval());
    ASSERT_TRUE(estimator_.q().allFinite() && estimator_.v().allFinite()) << "sample " << i;
  }
  for (int i = 0; i < 1000; ++i) update(q_.tail(robot_.nu()));
  EXPECT_LT((estimator_.q() - q_).tail(robot_.nu()).norm(), 1e-2);
  EXPECT_LT(estimator_.v().tail(robot_.nu()).norm(), 0.1);
}

}  // namespace
}  // namespace prowl

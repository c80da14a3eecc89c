#include "prowl/simulation/actuators.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/robots.hpp"

namespace prowl {
namespace {

class ActuatorsTest : public testing::Test {
 protected:
  RobotModel robot_ = test::hyq();
  Eigen::VectorXd q_ = robot_.nominal_configuration(), v_ = Eigen::VectorXd::Zero(robot_.nv());
  Eigen::VectorXd zero_ = Eigen::VectorXd::Zero(12), ten_ = Eigen::VectorXd::Constant(12, 10.0);
};

TEST_F(ActuatorsTest, WaitForTheDelay) {
  Actuators actuators(robot_, 5e-4, 2e-3, 0.0, zero_);
  actuators.command(ten_);
  for (int i = 0; i < 4; ++i) EXPECT_EQ(actuators.step(q_, v_), zero_) << i;
  EXPECT_EQ(actuators.step(q_, v_), ten_);
}

TEST_F(ActuatorsTest, FollowWithTheirBandwidth) {
  Actuators actuators(robot_, 5e-4, 0.0, 20.0, zero_);
  actuators.command(ten_);
  Eigen::VectorXd torque;
  const int steps = 16;  // 8 ms, one time constant 1 / (2 pi 20 Hz) = 7.96 ms
  for (int i = 0; i < steps; ++i) torque = actuators.step(q_, v_);
  EXPECT_NEAR(torque(3), 10.0 * (1.0 - std::exp(-2.0 * M_PI * 20.0 * 8e-3)), 1e-9);
}

TEST_F(ActuatorsTest, KeepTheLimits) {
  Actuators actuators(robot_, 5e-4, 0.0, 0.0, zero_);
  actuators.command(100.0 * ten_);
  EXPECT_LE(actuators.step(q_, v_).maxCoeff(), 150.0);
  EXPECT_TRUE(actuators.saturated());
  actuators.command(-ten_);
  EXPECT_EQ(actuators.step(q_, v_), -ten_);
  EXPECT_FALSE(actuators.saturated());
}

}  // namespace
}  // namespace prowl

#include "prowl/model/joint_losses.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace prowl {
namespace {

const JointLosses kLosses{Eigen::Vector2d(0.2, 0.0), Eigen::Vector2d(1.5, 0.0)};

TEST(JointLosses, AreDampingAndSmoothedFriction) {
  EXPECT_TRUE(kLosses.of(0) && kLosses.any());
  EXPECT_FALSE(kLosses.of(1));
  EXPECT_EQ(kLosses.torque(0, 0.0), 0.0);
  EXPECT_NEAR(kLosses.torque(0, JointLosses::kSlow), 0.2 * 0.05 + 1.5 * std::tanh(1.0), 1e-12);
  EXPECT_NEAR(kLosses.torque(0, 2.0), 0.2 * 2.0 + 1.5, 1e-12) << "all of the friction";
  EXPECT_EQ(kLosses.torque(0, -0.3), -kLosses.torque(0, 0.3));
  EXPECT_EQ(kLosses.torques(Eigen::Vector2d(2.0, 3.0)), Eigen::Vector2d(kLosses.torque(0, 2.0), 0.0));
}

TEST(JointLosses, HaveTheDerivativesOfDifferences) {
  constexpr double kStep = 1e-5;
  for (const double rate : {-1.0, -0.07, -0.01, 0.0, 0.02, 0.05, 0.3}) {
    EXPECT_NEAR(kLosses.slope(0, rate),
                (kLosses.torque(0, rate + kStep) - kLosses.torque(0, rate - kStep)) / (2.0 * kStep), 1e-5);
    EXPECT_NEAR(kLosses.curvature(0, rate),
                (kLosses.slope(0, rate + kStep) - kLosses.slope(0, rate - kStep)) / (2.0 * kStep), 1e-3);
  }
}

}  // namespace
}  // namespace prowl

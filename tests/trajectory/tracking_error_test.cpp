#include "prowl/trajectory/tracking_error.hpp"

#include <gtest/gtest.h>

#include "prowl/model/configuration.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

TEST(TrackingError, IsTheSizeOfWhatWasAdded) {
  const RobotModel robot = test::hyq();
  std::mt19937 rng(2);
  TrackingError error;
  double largest = 0.0, squares = 0.0, rest = 0.0;
  constexpr int kSamples = 50;
  for (int i = 0; i < kSamples; ++i) {
    const VectorXd off = test::random_vector(rng, robot.nv(), 0.1);
    const bool at_rest = i >= 40;
    error.add(robot.nominal_configuration(), integrate(robot.nominal_configuration(), off), at_rest);
    const double size = off.head<3>().norm();
    largest = std::max(largest, size);
    squares += size * size;
    if (at_rest) rest = std::max(rest, size);
  }
  EXPECT_NEAR(error.base_position().largest, largest, 1e-12);
  EXPECT_NEAR(error.base_position().rms, std::sqrt(squares / kSamples), 1e-12);
  EXPECT_NEAR(error.base_position().rest, rest, 1e-12);
  EXPECT_LT(rest, largest) << "a seed that tells nothing";
  EXPECT_LE(error.joints().rms, error.joints().largest);
}

// Whichever way it goes: a little less is not a fall, a little more is.
TEST(TrackingError, FallsAtAThirdOfItsHeightOrHalfARadian) {
  for (const RobotModel& robot : {test::hyq(), test::go2()}) {
    const VectorXd& q = robot.nominal_configuration();
    std::mt19937 rng(1);
    for (int i = 0; i < 10; ++i) {
      const Eigen::Vector3d way = test::random_vector(rng, 3, 1.0).normalized();
      for (const double share : {0.99, 1.01}) {
        VectorXd move = VectorXd::Zero(robot.nv());
        move.head<3>() = share * q(2) / 3.0 * way;
        EXPECT_EQ(has_fallen(robot, q, integrate(q, move)), share > 1.0);
        move.setZero();
        move.segment<3>(3) = share * 0.5 * way;
        EXPECT_EQ(has_fallen(robot, q, integrate(q, move)), share > 1.0);
      }
    }
  }
}

}  // namespace
}  // namespace prowl

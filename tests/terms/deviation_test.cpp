#include "prowl/terms/deviation.hpp"

#include <gtest/gtest.h>

#include "prowl/error.hpp"
#include "prowl/terms/term_derivatives.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;

const Quantity kJoints{.kind = Quantity::Kind::joints};

/// Two joints that move from (1, 2) over (3, 0) to (4, 4).
TimedValues reference() {
  return {Eigen::Vector3d(0.1, 0.3, 0.4), (MatrixXd(2, 3) << 1.0, 3.0, 4.0, 2.0, 0.0, 4.0).finished()};
}

TEST(Deviation, IsLinearBetweenTheTimesAndConstantOutside) {
  const RobotModel robot = test::hyq();
  const auto term = deviation(kJoints, {5, 2}, {"a", "b"}, "rad", reference());
  VectorXd y = VectorXd::Zero(robot.nu() + 1);
  const auto at = [&](double time) {
    y(robot.nu()) = time;
    VectorXd f(2);
    term->value(y, f);
    return Vector2d(-f);  // of zero positions
  };
  EXPECT_EQ(at(0.0), Vector2d(1.0, 2.0));
  EXPECT_EQ(at(0.1), Vector2d(1.0, 2.0));
  EXPECT_TRUE(at(0.2).isApprox(Vector2d(2.0, 1.0)));
  EXPECT_TRUE(at(0.375).isApprox(Vector2d(3.75, 3.0)));
  EXPECT_EQ(at(0.4), Vector2d(4.0, 4.0));
  EXPECT_EQ(at(9.0), Vector2d(4.0, 4.0));
  y(5) = 10.0;
  y(2) = 20.0;
  EXPECT_EQ(at(9.0), Vector2d(-6.0, -16.0));
}

TEST(Deviation, DerivativesAreThoseOfDifferences) {
  const RobotModel robot = test::hyq();
  const auto term = deviation(kJoints, {5, 2}, {"a", "b"}, "rad", reference());
  std::mt19937 rng(1);
  for (const double time : {0.05, 0.15, 0.33, 0.5}) {
    VectorXd y = test::random_vector(rng, robot.nu() + 1, 1.0);
    y(robot.nu()) = time;
    EXPECT_EQ(wrong_derivative(robot, *term, y), "") << time;
  }
}

TEST(Deviation, RefusesWhatDoesNotFit) {
  const auto refused = [](TimedValues wrong) {
    EXPECT_THROW(deviation(kJoints, {5, 2}, {"a", "b"}, "rad", std::move(wrong)), InputError);
  };
  refused({Vector2d(0.0, 1.0), MatrixXd::Zero(2, 3)});
  refused({Vector2d(0.0, 1.0), MatrixXd::Zero(3, 2)});
  refused({Vector2d(1.0, 1.0), MatrixXd::Zero(2, 2)});
  refused({Vector2d(0.0, NAN), MatrixXd::Zero(2, 2)});
  refused({Vector2d(0.0, 1.0), MatrixXd::Constant(2, 2, INFINITY)});
  refused({VectorXd(), MatrixXd(2, 0)});
}

}  // namespace
}  // namespace prowl

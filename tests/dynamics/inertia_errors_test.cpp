#include "prowl/dynamics/inertia_errors.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// Inverse dynamics are linear in masses and inertias: all of them once more are r0 once more.
TEST(InertiaErrors, OfAllMassAddUpToInverseDynamics) {
  const RobotModel robot = test::hyq();
  InertiaErrors errors(robot);
  RigidBodyTerms terms(robot);
  test::RandomStates random(robot, 1);
  for (int i = 0; i < 100; ++i) {
    const Eigen::VectorXd q = random.configuration(), v = random.velocity(), a = random.velocity();
    terms.update(q, v, a);
    const Eigen::MatrixXd forces = errors.forces(q, v, a, 1.0, 0.01);
    ASSERT_EQ(forces.cols(), robot.nu() + 1 + 3);
    const Eigen::VectorXd sum = forces.leftCols(robot.nu() + 1).rowwise().sum();
    EXPECT_LT((sum - terms.inverse_dynamics()).norm(), 1e-9 * terms.inverse_dynamics().norm());
  }
}

/// At rest and upright the displaced weight of the base turns it.
TEST(InertiaErrors, OfTheCentreOfMassAreTheMomentOfTheWeight) {
  const RobotModel robot = test::hyq();
  InertiaErrors errors(robot);
  const Eigen::VectorXd zero = Eigen::VectorXd::Zero(robot.nv());
  constexpr double kWay = 0.02;
  const Eigen::MatrixXd forces = errors.forces(robot.nominal_configuration(), zero, zero, 0.1, kWay);
  const double weight_of_base = forces(2, 0) / 0.1;
  EXPECT_GT(weight_of_base, 0.4 * robot.weight());
  const Eigen::MatrixXd moments = forces.rightCols<3>();
  EXPECT_NEAR(moments(4, 0), -kWay * weight_of_base, 1e-9) << "forward: nose down needs a moment nose up";
  EXPECT_NEAR(moments(3, 1), kWay * weight_of_base, 1e-9);
  EXPECT_LT(moments.topRows<3>().norm() + moments.col(2).norm(), 1e-9);
}

}  // namespace
}  // namespace prowl

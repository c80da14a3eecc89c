#include "prowl/dynamics/inverse_kinematics.hpp"

#include <gtest/gtest.h>

#include <random>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

/// Targets of all contacts where the posture q has them.
std::vector<ContactTarget> targets_at(const RobotModel& robot, const VectorXd& q) {
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  std::vector<ContactTarget> targets;
  for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) targets.push_back({c, terms.contact_position(c)});
  return targets;
}

double sum_of_squares(const RobotModel& robot, const VectorXd& q, const std::vector<ContactTarget>& targets) {
  const std::vector<ContactTarget> reached = targets_at(robot, q);
  double sum = 0.0;
  for (const ContactTarget& target : targets) {
    sum += (reached[target.contact].position - target.position).squaredNorm();
  }
  return sum;
}

void expect_within_limits(const RobotModel& robot, const VectorXd& q) {
  EXPECT_TRUE((q.tail(robot.nu()).array() >= robot.position_lower().array()).all());
  EXPECT_TRUE((q.tail(robot.nu()).array() <= robot.position_upper().array()).all());
}

class InverseKinematicsOf : public testing::TestWithParam<RobotDescription> {};

TEST_P(InverseKinematicsOf, FindsAPostureThatExists) {
  const RobotModel robot(GetParam());
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-0.15, 0.15);
  for (int trial = 0; trial < 20; ++trial) {
    VectorXd change = VectorXd::NullaryExpr(robot.nv(), [&] { return uniform(random); });
    VectorXd wanted = integrate(robot.nominal_configuration(), change);
    wanted.tail(robot.nu()) =
        wanted.tail(robot.nu()).cwiseMax(robot.position_lower()).cwiseMin(robot.position_upper()).eval();
    VectorXd guess = robot.nominal_configuration();
    guess.head<7>() = wanted.head<7>();
    const auto targets = targets_at(robot, wanted);
    ASSERT_GT(sum_of_squares(robot, guess, targets), 1e-6) << "nothing to find";

    const InverseKinematics found = inverse_kinematics(robot, guess, targets);
    EXPECT_TRUE(found.converged) << "residual " << found.residual;
    EXPECT_LT(sum_of_squares(robot, found.q, targets), 1e-14);
    EXPECT_EQ(found.q.head<7>(), wanted.head<7>());
    expect_within_limits(robot, found.q);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, InverseKinematicsOf,
                         testing::Values(test::hyq_description(), test::anymal_c_description(),
                                         test::solo12_description(), test::go2_description(),
                                         test::talos_description()),
                         [](const auto& info) { return info.param.name.substr(0, info.param.name.find(' ')); });

TEST(InverseKinematics, StaysAtTheNearestPostureWithinLimitsWhereTargetsAreOutOfReach) {
  const RobotModel robot = test::hyq();
  VectorXd guess = robot.nominal_configuration();
  const auto targets = targets_at(robot, guess);
  guess.head<3>() += Eigen::Vector3d(0.1, 0.05, -0.45);  // the base almost on the floor: knees and hips at their limits

  const InverseKinematics found = inverse_kinematics(robot, guess, targets);
  EXPECT_FALSE(found.converged);
  EXPECT_GT(found.residual, 0.01);
  expect_within_limits(robot, found.q);
  const double best = sum_of_squares(robot, found.q, targets);
  EXPECT_LT(best, sum_of_squares(robot, guess, targets));
  for (int joint = 0; joint < robot.nu(); ++joint) {
    for (const double step : {-1e-4, 1e-4}) {
      VectorXd q = found.q;
      q(7 + joint) = std::clamp(q(7 + joint) + step, robot.position_lower()(joint), robot.position_upper()(joint));
      EXPECT_GE(sum_of_squares(robot, q, targets), best - 1e-9) << robot.joint_names()[static_cast<size_t>(joint)];
    }
  }
}

TEST(InverseKinematics, MovesOnlyTheLegThatHasATarget) {
  const RobotModel robot = test::hyq();
  const VectorXd guess = robot.nominal_configuration();
  ContactTarget target = targets_at(robot, guess).front();
  target.position += Eigen::Vector3d(0.05, 0.02, 0.06);
  const InverseKinematics found = inverse_kinematics(robot, guess, {target});
  EXPECT_TRUE(found.converged);
  const VectorXd change = found.q - guess;
  EXPECT_EQ((change.array() != 0.0).count(), 3) << change.transpose();
}

TEST(InverseKinematics, PutsAGuessOutsideTheLimitsInside) {
  const RobotModel robot = test::hyq();
  VectorXd guess = robot.nominal_configuration();
  const auto targets = targets_at(robot, guess);
  guess(7) = robot.position_upper()(0) + 0.3;
  expect_within_limits(robot, inverse_kinematics(robot, guess, {}).q);
  const InverseKinematics found = inverse_kinematics(robot, guess, targets);
  EXPECT_TRUE(found.converged);
  expect_within_limits(robot, found.q);
}

}  // namespace
}  // namespace prowl

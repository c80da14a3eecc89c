#include "prowl/certificate/sampled_limits.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "tests/certificate/certificate_cases.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using test::Case;
using test::failed_checks;
using test::find;
using test::Names;
using test::standing;

constexpr int kKnee = 2;  // lf_kfe_joint

TEST(SampledLimits, TorqueLimitsOverPositionHoldAtThePosture) {
  Case c = standing(test::hyq());
  const double torque = std::abs(c.trajectory.nodes[0].tau(kKnee)), knee = c.trajectory.nodes[0].q(7 + kKnee);
  const RobotModel& robot = c.discrete.problem.robot;
  const double lower = robot.position_lower()(kKnee), upper = robot.position_upper()(kKnee);
  for (const double part : {1.02, 0.98}) {
    RobotDescription description = test::hyq_description();
    for (const double x : {lower, 0.5 * (lower + knee), knee, 0.5 * (knee + upper), upper}) {
      description.limits["lf_kfe_joint"].torque_over_position.push_back({x, torque * (part + std::abs(x - knee))});
    }
    c.discrete.problem.robot = RobotModel(description);
    const Certificate certificate = certify(c.discrete, c.trajectory);
    EXPECT_EQ(failed_checks(certificate), part > 1.0 ? Names{} : Names{"joint torque"});
    EXPECT_NEAR(find(certificate, "joint torque").worst, 1.0 / part, 1e-6);
  }
}

/// Between two nodes at the limit the knee goes there and back: with velocities u and -u at them by u h / 4.
TEST(SampledLimits, HoldBetweenTheNodes) {
  Case c = standing(test::hyq());
  RobotDescription description = test::hyq_description();
  const double knee = c.trajectory.nodes[0].q(7 + kKnee), u = 0.4;
  description.limits["lf_kfe_joint"].position_upper = knee;
  c.discrete.problem.robot = RobotModel(description);
  EXPECT_NEAR(find(certify(c.discrete, c.trajectory), "joint position beyond limit").worst, 0.0, 1e-12);
  TrajectoryPoint &left = c.trajectory.nodes[0], &right = c.trajectory.nodes[1];  // before them nothing is
  left.v(6 + kKnee) = u;
  right.v(6 + kKnee) = -u;
  const double there = 0.25 * u * (right.time - left.time);
  EXPECT_NEAR(find(certify(c.discrete, c.trajectory), "joint position beyond limit").worst, there, 0.2 * there);
}

/// A motor: less torque the faster the knee turns in the direction of the torque (v > 0) [N m], of one that gives
/// `strength` at rest.
double motor_limit(double strength, double v) { return strength * (1.0 - std::tanh(v) / 1.2); }

/// Largest |torque| of the knee at the nodes over what that motor gives, at the velocity there times `direction`.
double largest_ratio(const Trajectory& trajectory, double strength, double direction) {
  constexpr double kUrdfLimit = 150.0;  // [N m]
  double largest = 0.0;
  for (const TrajectoryPoint& node : trajectory.nodes) {
    const double torque = node.tau(kKnee), driving = direction * std::copysign(1.0, torque) * node.v(6 + kKnee);
    largest = std::max(largest, std::abs(torque) / std::min(kUrdfLimit, motor_limit(strength, driving)));
  }
  return largest;
}

TEST(SampledLimits, TorqueLimitsOverVelocityCountInTheDirectionOfTheTorque) {
  Case c = test::crouching(test::hyq(), 160);
  c.trajectory.nodes.resize(81);  // only down, so that driving and braking are not the same
  c = test::stance_case(test::hyq(), c.trajectory);
  double largest = 0.0;
  for (const TrajectoryPoint& node : c.trajectory.nodes) largest = std::max(largest, std::abs(node.tau(kKnee)));
  const double fastest = c.discrete.problem.robot.velocity_limit()(kKnee), strength = 1.2 * largest;
  RobotDescription description = test::hyq_description();
  for (int i = -50; i <= 50; ++i) {
    const double v = fastest * i / 50;
    description.limits["lf_kfe_joint"].torque_over_velocity.push_back({v, motor_limit(strength, v)});
  }
  c.discrete.problem.robot = RobotModel(description);

  const double expected = largest_ratio(c.trajectory, strength, 1.0);
  EXPECT_GT(std::abs(largest_ratio(c.trajectory, strength, -1.0) - expected), 0.05)
      << "the direction makes no difference here";
  const CertificateCheck check = find(certify(c.discrete, c.trajectory), "joint torque");
  EXPECT_NEAR(check.worst, expected, 1e-3);
  EXPECT_EQ(check.where, "lf_kfe_joint");
}

}  // namespace
}  // namespace prowl

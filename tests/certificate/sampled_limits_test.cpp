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

/// Largest |torque| of the knee at the nodes over its limit at the velocity there, times `direction`.
double largest_ratio(const Case& c, double direction) {
  double largest = 0.0;
  for (const TrajectoryPoint& node : c.trajectory.nodes) {
    const double torque = node.tau(kKnee), v = direction * node.v(6 + kKnee);
    const double limit = torque > 0.0 ? c.discrete.problem.robot.torque_upper(kKnee, node.q(7 + kKnee), v)
                                      : -c.discrete.problem.robot.torque_lower(kKnee, node.q(7 + kKnee), v);
    largest = std::max(largest, std::abs(torque) / limit);
  }
  return largest;
}

TEST(SampledLimits, TorqueLimitsOverVelocityCountInTheDirectionOfTheTorque) {
  Case c = test::crouching(test::hyq(), 160);
  c.trajectory.nodes.resize(81);  // only down, so that driving and braking are not the same
  c = test::stance_case(test::hyq(), c.trajectory);
  double largest = 0.0;
  for (const TrajectoryPoint& node : c.trajectory.nodes) largest = std::max(largest, std::abs(node.tau(kKnee)));
  const double fastest = c.discrete.problem.robot.velocity_limit()(kKnee);
  RobotDescription description = test::hyq_description();
  for (int i = -50; i <= 50; ++i) {
    const double v = fastest * i / 50;
    description.limits["lf_kfe_joint"].torque_over_velocity.push_back({v, largest * (1.2 - std::tanh(v))});
  }
  c.discrete.problem.robot = RobotModel(description);

  const double expected = largest_ratio(c, 1.0);
  EXPECT_GT(std::abs(largest_ratio(c, -1.0) - expected), 0.05) << "the direction makes no difference here";
  const CertificateCheck check = find(certify(c.discrete, c.trajectory), "joint torque");
  EXPECT_NEAR(check.worst, expected, 1e-3);
  EXPECT_EQ(check.where, "lf_kfe_joint");
}

}  // namespace
}  // namespace prowl

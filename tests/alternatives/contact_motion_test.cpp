#include "alternatives/contact_motion.hpp"

#include <gtest/gtest.h>

#include "prowl/certificate/constrained_dynamics_oracle.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

/// On all feet, then on two of them.
MotionProblem two_phases() {
  MotionProblem problem = test::standing_problem();
  Phase second = problem.phases.front();
  second.contacts = {problem.phases.front().contacts[3], problem.phases.front().contacts[1]};
  problem.phases.push_back(second);
  return problem;
}

TrajectoryPoint random_node(const RobotModel& robot, int phase, test::RandomStates& random) {
  TrajectoryPoint node{
      .phase = phase, .q = random.configuration(), .v = random.velocity(), .a = {}, .tau = {}, .force = {}};
  node.a = 5.0 * random.vector(robot.nv());
  return node;
}

/// Velocities of the contacts so much later, if a stays.
Eigen::Matrix3Xd velocities_after(ConstrainedDynamicsOracle& oracle, const TrajectoryPoint& node, double time) {
  return oracle.contact_points(integrate(node.q, time * tangent_rate(node)), node.v + time * node.a).velocity;
}

/// The rate of what contact points do, by differences in time.
ContactMotion by_differences(const MotionProblem& problem, const TrajectoryPoint& node) {
  ConstrainedDynamicsOracle oracle(problem.robot, {});
  constexpr double kStep = 1e-5;  // [s]
  const Eigen::Matrix3Xd velocity = velocities_after(oracle, node, 0.0);
  const Eigen::Matrix3Xd rate =
      (velocities_after(oracle, node, kStep) - velocities_after(oracle, node, -kStep)) / (2.0 * kStep);
  ContactMotion worst;
  for (const PhaseContact& held : problem.phases[node.phase].contacts) {
    worst.velocity = std::max(worst.velocity, velocity.col(held.contact).norm());
    worst.acceleration = std::max(worst.acceleration, rate.col(held.contact).norm());
  }
  return worst;
}

TEST(ContactMotion, IsWhatDifferencesInTimeSay) {
  const MotionProblem problem = two_phases();
  test::RandomStates random(problem.robot, 5);
  for (int i = 0; i < 100; ++i) {
    const TrajectoryPoint node = random_node(problem.robot, i % 2, random);
    const ContactMotion motion = contact_motion(problem, {{node}}), expected = by_differences(problem, node);
    EXPECT_NEAR(motion.velocity, expected.velocity, 1e-12);
    EXPECT_NEAR(motion.acceleration, expected.acceleration, 1e-6 * expected.acceleration);
    EXPECT_GT(expected.velocity, 0.1);
  }
}

TEST(ContactMotion, IsTheWorstOfAllNodes) {
  const MotionProblem problem = two_phases();
  test::RandomStates random(problem.robot, 6);
  const TrajectoryPoint first = random_node(problem.robot, 0, random), second = random_node(problem.robot, 1, random);
  const ContactMotion alone[] = {contact_motion(problem, {{first}}), contact_motion(problem, {{second}})};
  for (const Trajectory& motion : {Trajectory{{first, second}}, Trajectory{{second, first}}}) {
    EXPECT_EQ(contact_motion(problem, motion).velocity, std::max(alone[0].velocity, alone[1].velocity));
    EXPECT_EQ(contact_motion(problem, motion).acceleration, std::max(alone[0].acceleration, alone[1].acceleration));
  }
}

TEST(ContactMotion, IsNoneInFlight) {
  MotionProblem problem = test::standing_problem();
  problem.phases.front().contacts.clear();
  test::RandomStates random(problem.robot, 7);
  const ContactMotion motion = contact_motion(problem, {{random_node(problem.robot, 0, random)}});
  EXPECT_EQ(motion.velocity, 0.0);
  EXPECT_EQ(motion.acceleration, 0.0);
}

}  // namespace
}  // namespace prowl

#include "prowl/certificate/contact_states.hpp"

#include <gtest/gtest.h>

#include "tests/certificate/stance_motion.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

constexpr int kStep = 0, kNever = 1, kStays = 2;  // contacts: steps from surface 0 to 1, never touches, always on 0

/// Three phases of one interval; the base moves 1 cm a node along x, and all contacts with it.
ContactStates stepping() {
  const RobotModel robot = test::hyq();
  Trajectory trajectory;
  for (int node = 0; node < 6; ++node) {
    TrajectoryPoint point;
    point.time = 0.5 * ((node + 1) / 2);
    point.phase = node / 2;
    point.q = robot.nominal_configuration();
    point.q(0) += 0.01 * node;
    point.v = Eigen::VectorXd::Zero(robot.nv());
    trajectory.nodes.push_back(point);
  }
  MotionProblem problem = test::problem_of(robot, trajectory);
  Phase phase{"", {{kStays, 0}}, {0.5, 0.5}};
  problem.phases.assign(3, phase);
  problem.phases[0].contacts.push_back({kStep, 0});
  problem.phases[2].contacts.push_back({kStep, 1});
  problem.surfaces.assign(3, Surface{});

  PhaseDynamics dynamics;
  for (int p = 0; p < 3; ++p) dynamics.emplace_back(robot, std::vector<int>{});
  return contact_states({std::move(problem), {std::vector(3, PhaseMesh(1))}}, trajectory, dynamics);
}

TEST(ContactStates, AContactThatStaysKeepsItsAnchor) {
  const ContactStates states = stepping();
  for (int p = 1; p < 3; ++p) {
    EXPECT_FALSE(states[p][kStays].closes);
    EXPECT_EQ(states[p][kStays].anchor, states[0][kStays].anchor);
    EXPECT_EQ(states[p][kStays].time, 0.0);
  }
}

TEST(ContactStates, AContactThatClosesIsAnchoredAtTheFirstNodeOfThatPhase) {
  const ContactStates states = stepping();
  const ContactState &before = states[0][kStep], &after = states[2][kStep];
  EXPECT_TRUE(before.closes);
  EXPECT_TRUE(after.closes);
  EXPECT_FALSE(states[1][kStep].surface.has_value());
  EXPECT_EQ(after.time, 1.0);
  EXPECT_NEAR((after.anchor - before.anchor).x(), 0.04, 1e-12);  // four nodes later
}

TEST(ContactStates, AContactOpensAtTheEndOfItsStanceAndSwingsToTheNext) {
  const ContactStates states = stepping();
  EXPECT_TRUE(states[0][kStep].opens);
  EXPECT_FALSE(states[0][kStep].swings);
  EXPECT_FALSE(states[1][kStep].opens);
  EXPECT_TRUE(states[1][kStep].swings);
  EXPECT_FALSE(states[2][kStep].opens) << "the end of the motion opens nothing";
  for (int p = 0; p < 3; ++p) {
    EXPECT_FALSE(states[p][kStays].opens || states[p][kStays].swings);
    EXPECT_FALSE(states[p][kNever].opens || states[p][kNever].swings);
  }
}

}  // namespace
}  // namespace prowl

#include "prowl/transcription/remesh.hpp"

#include <gmock/gmock.h>

#include "../support/robots.hpp"
#include "prowl/error.hpp"

namespace prowl {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pointwise;

Phase phase_of(int intervals, std::vector<double> shares = {}) {
  return {.name = "p", .duration = {1.0, 1.0}, .intervals = intervals, .shares = std::move(shares)};
}

TEST(Remesh, AnEqualMeshStaysEqual) {
  Phase phase = phase_of(4);
  set_steps(phase, steps_with(phase, 7));
  EXPECT_EQ(phase.intervals, 7);
  EXPECT_THAT(phase.shares, IsEmpty());
}

TEST(Remesh, AnUnevenMeshKeepsItsDensity) {
  const Phase phase = phase_of(4, {0.1, 0.1, 0.3, 0.5});
  EXPECT_THAT(steps_with(phase, 4), Pointwise(DoubleNear(1e-15), phase.shares));
  EXPECT_THAT(steps_with(phase, 8), Pointwise(DoubleNear(1e-15), {0.05, 0.05, 0.05, 0.05, 0.15, 0.15, 0.25, 0.25}));
  EXPECT_THAT(steps_with(phase, 2), Pointwise(DoubleNear(1e-15), {0.2, 0.8}));
  // Nodes where 4/3 and 8/3 of the old intervals are over.
  EXPECT_THAT(steps_with(phase, 3), Pointwise(DoubleNear(1e-15), {0.4 / 3.0, 0.8 / 3.0, 0.6}));
}

TEST(Remesh, StepsAreProportions) {
  Phase phase = phase_of(4);
  set_steps(phase, {2.0, 6.0});
  EXPECT_EQ(phase.intervals, 2);
  EXPECT_THAT(phase.shares, ElementsAre(0.25, 0.75));
  EXPECT_EQ(phase.node_time(1, 2.0), 0.5);
  EXPECT_EQ(phase.node_time(2, 0.7), 0.7);
  set_steps(phase, {3.0, 3.0, 3.0});
  EXPECT_THAT(phase.shares, IsEmpty());
}

TEST(Remesh, GoalsStayWhereTheyAre) {
  MotionProblem problem{.robot = test::hyq()};
  problem.phases = {phase_of(4), phase_of(10)};
  const auto at = [&](NodeRef node) {
    return BoundaryCondition::unbounded(problem.robot, "goal 7", node, problem.robot.nominal_configuration());
  };
  problem.boundary_conditions = {at({0, 0}), at({0, 1}), at({1, 4}), at({1, 10})};
  const MotionProblem other = on_mesh(problem, {{1.0, 2.0, 1.0}, {0.1, 0.3, 0.2, 0.4}});
  std::vector<NodeRef> nodes;
  for (const BoundaryCondition& condition : other.boundary_conditions) nodes.push_back(condition.at);
  EXPECT_EQ(nodes, (std::vector<NodeRef>{{0, 0}, {0, 1}, {1, 2}, {1, 4}}));
  EXPECT_THROW(on_mesh(problem, {{1.0, 1.0}, {1.0, 1.0}}), InputError) << "no node at a quarter of the first phase";
}

}  // namespace
}  // namespace prowl

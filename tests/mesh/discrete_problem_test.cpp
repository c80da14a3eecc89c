#include "prowl/mesh/discrete_problem.hpp"

#include <gmock/gmock.h>

#include "prowl/error.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using testing::ElementsAre;

const Mesh kMesh{{PhaseMesh(7), PhaseMesh(3), PhaseMesh(1)}};

MotionProblem three_phases() {
  MotionProblem problem = test::standing_problem();
  problem.phases = {{.name = "fixed", .contacts = {}, .duration = {0.7, 0.7}},
                    {.name = "free", .contacts = {}, .duration = {0.2, 0.6}},
                    {.name = "one step", .contacts = {}, .duration = {0.1, 0.1}}};
  return problem;
}

void add_goal(MotionProblem& problem, PhaseFraction at) {
  problem.boundary_constraints.push_back(
      BoundaryConstraint::unbounded(problem.robot, "goal 7", at, problem.start_configuration()));
}

std::string message_for(const MotionProblem& problem, const Mesh& mesh) {
  try {
    DiscreteProblem(problem, mesh);
  } catch (const InputError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(DiscreteProblem, CutsEachPhaseIntoEqualSteps) {
  const DiscreteProblem discrete(three_phases(), kMesh);
  const std::vector<MeshNode>& nodes = discrete.nodes;
  ASSERT_EQ(discrete.num_nodes(), 8 + 4 + 2);
  EXPECT_EQ(nodes.front().time, 0.0);
  EXPECT_DOUBLE_EQ(nodes.back().time, 0.7 + 0.4 + 0.1);  // 0.4 s: the middle of what is allowed
  int intervals = 0;
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    const MeshNode &left = nodes[k], &right = nodes[k + 1];
    EXPECT_NEAR(right.time - left.time, left.h_out, 1e-15);
    EXPECT_EQ(left.h_out, right.h_in);
    EXPECT_EQ(left.h_out > 0.0, left.phase == right.phase);
    EXPECT_EQ(discrete.is_interval(static_cast<int>(k)), left.phase == right.phase);
    intervals += left.h_out > 0.0;
  }
  EXPECT_EQ(intervals, 7 + 3 + 1);
  EXPECT_DOUBLE_EQ(nodes[0].h_out, 0.1);
  EXPECT_DOUBLE_EQ(nodes[8].h_out, 0.4 / 3.0);
}

TEST(DiscreteProblem, HasTheStepsThatAMeshAsksFor) {
  const DiscreteProblem equal(three_phases(), kMesh),
      uneven(three_phases(), {{PhaseMesh(7), PhaseMesh({0.5, 0.2, 0.3}), PhaseMesh(1)}});
  const std::vector<MeshNode>& nodes = uneven.nodes;
  ASSERT_EQ(nodes.size(), equal.nodes.size());
  EXPECT_NEAR(nodes[9].time - nodes[8].time, 0.2, 1e-15);
  EXPECT_NEAR(nodes[10].time - nodes[9].time, 0.08, 1e-15);
  for (std::size_t k = 0; k + 1 < nodes.size(); ++k) {
    EXPECT_NEAR(nodes[k + 1].time - nodes[k].time, nodes[k].h_out, 1e-15);
    EXPECT_EQ(nodes[k].h_out, nodes[k + 1].h_in);
  }
  EXPECT_EQ(nodes[11].time, equal.nodes[11].time) << "the end of the phase, exactly";
}

TEST(DiscreteProblem, PutsBothSidesOfAPhaseTransitionAtOneTime) {
  const DiscreteProblem discrete(three_phases(), kMesh);
  const MeshNode &before = discrete.nodes[7], &after = discrete.nodes[8];
  EXPECT_EQ(before.phase, 0);
  EXPECT_EQ(after.phase, 1);
  EXPECT_EQ(before.time, after.time);
  EXPECT_EQ(before.h_out, 0.0);
  EXPECT_EQ(after.h_in, 0.0);
  EXPECT_FALSE(discrete.is_interval(7));
}

TEST(DiscreteProblem, FindsEveryNode) {
  const DiscreteProblem discrete(three_phases(), kMesh);
  for (int k = 0; k < discrete.num_nodes(); ++k) {
    const MeshNode& node = discrete.nodes[k];
    EXPECT_EQ(discrete.mesh.node(node.phase, node.node), k);
  }
}

TEST(DiscreteProblem, SaysInWordsWhereANodeIs) {
  const DiscreteProblem discrete(three_phases(), kMesh);
  EXPECT_EQ(discrete.describe_node(10), "phase 2 'free', node 2");
  EXPECT_EQ(discrete.describe_moment(6), "phase 1 'fixed', node 6, t = 0.600 s");
}

TEST(DiscreteProblem, KnowsTheNodesOfItsBoundaryConstraints) {
  MotionProblem problem = three_phases();
  problem.phases[1].duration = {0.4, 0.4};
  for (const PhaseFraction at : {PhaseFraction{0, 3.0 / 7.0}, PhaseFraction::end_of(0), PhaseFraction::start_of(1),
                                 PhaseFraction{1, 1.0 / 3.0}, PhaseFraction::end_of(2)}) {
    add_goal(problem, at);
  }
  const DiscreteProblem discrete(problem, kMesh);
  EXPECT_THAT(discrete.boundary_nodes, ElementsAre(0, 3, 7, 8, 9, 13));
  EXPECT_NEAR(discrete.boundary_time(1), 0.3, 1e-15);
  EXPECT_EQ(discrete.boundary_time(2), discrete.boundary_time(3)) << "both sides of a phase switch";
}

/// On any mesh that has a node for them.
TEST(DiscreteProblem, GoalsStayWhereTheyAre) {
  MotionProblem problem = test::standing_problem();
  problem.phases.assign(2, {.name = "p", .contacts = {}, .duration = {1.0, 1.0}});
  for (const PhaseFraction at : {PhaseFraction{0, 0.25}, PhaseFraction{1, 0.4}, PhaseFraction{1, 1.0}}) {
    add_goal(problem, at);
  }
  const Mesh equal{{PhaseMesh(4), PhaseMesh(10)}}, other{{PhaseMesh({1.0, 2.0, 1.0}), PhaseMesh({0.1, 0.3, 0.2, 0.4})}};
  EXPECT_THAT(find_boundary_nodes(problem, equal), ElementsAre(0, 1, 5 + 4, 5 + 10));
  EXPECT_THAT(find_boundary_nodes(problem, other), ElementsAre(0, 1, 4 + 2, 4 + 4));
  const DiscreteProblem before(problem, equal), after(problem, other);
  for (std::size_t c = 0; c < 4; ++c) EXPECT_NEAR(after.boundary_time(c), before.boundary_time(c), 1e-12);
  EXPECT_EQ(message_for(problem, {{PhaseMesh({1.0, 1.0}), PhaseMesh({1.0, 1.0})}}),
            "goal 7: no node of the mesh is at 0.25 of phase 'p'");
}

TEST(DiscreteProblem, RefusesWhatDoesNotFit) {
  EXPECT_EQ(message_for(three_phases(), kMesh), "accepted");
  EXPECT_EQ(message_for(three_phases(), {{PhaseMesh(7), PhaseMesh(3)}}),
            "mesh: 2 phases are not allowed; the problem has 3");
  MotionProblem problem = three_phases();
  problem.swing_clearance = -0.1;
  EXPECT_THAT(message_for(problem, kMesh), testing::HasSubstr("swing_clearance: -0.1 is not allowed"))
      << "as validate() does";
}

}  // namespace
}  // namespace prowl

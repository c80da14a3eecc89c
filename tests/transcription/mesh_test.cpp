#include "prowl/transcription/mesh.hpp"

#include <gtest/gtest.h>

#include "../support/robots.hpp"

namespace prowl {
namespace {

MotionProblem three_phases() {
  MotionProblem problem{.robot = test::hyq()};
  problem.phases = {{.name = "fixed", .duration = {0.7, 0.7}, .intervals = 7},
                    {.name = "free", .duration = {0.2, 0.6}, .intervals = 3},
                    {.name = "one step", .duration = {0.1, 0.1}, .intervals = 1}};
  return problem;
}

TEST(Mesh, CutsEachPhaseIntoEqualSteps) {
  const Mesh mesh = make_mesh(three_phases());
  ASSERT_EQ(mesh.size(), 8 + 4 + 2);
  EXPECT_EQ(mesh.nodes.front().time, 0.0);
  EXPECT_DOUBLE_EQ(mesh.nodes.back().time, 0.7 + 0.4 + 0.1);  // 0.4 s: the middle of what is allowed
  int intervals = 0;
  for (std::size_t k = 0; k + 1 < mesh.nodes.size(); ++k) {
    const MeshNode &left = mesh.nodes[k], &right = mesh.nodes[k + 1];
    EXPECT_NEAR(right.time - left.time, left.h_out, 1e-15);
    EXPECT_EQ(left.h_out, right.h_in);
    EXPECT_EQ(left.h_out > 0.0, left.phase == right.phase);
    intervals += left.h_out > 0.0;
  }
  EXPECT_EQ(intervals, 7 + 3 + 1);
  EXPECT_DOUBLE_EQ(mesh.nodes[0].h_out, 0.1);
  EXPECT_DOUBLE_EQ(mesh.nodes[8].h_out, 0.4 / 3.0);
}

TEST(Mesh, HasTheStepsThatAPhaseAsksFor) {
  MotionProblem problem = three_phases();
  problem.phases[1].shares = {0.5, 0.2, 0.3};
  const Mesh mesh = make_mesh(problem), equal = make_mesh(three_phases());
  ASSERT_EQ(mesh.size(), equal.size());
  EXPECT_NEAR(mesh.nodes[9].time - mesh.nodes[8].time, 0.2, 1e-15);
  EXPECT_NEAR(mesh.nodes[10].time - mesh.nodes[9].time, 0.08, 1e-15);
  for (std::size_t k = 0; k + 1 < mesh.nodes.size(); ++k) {
    EXPECT_NEAR(mesh.nodes[k + 1].time - mesh.nodes[k].time, mesh.nodes[k].h_out, 1e-15);
    EXPECT_EQ(mesh.nodes[k].h_out, mesh.nodes[k + 1].h_in);
  }
  EXPECT_EQ(mesh.nodes[11].time, equal.nodes[11].time) << "the end of the phase, exactly";
}

TEST(Mesh, PutsBothSidesOfAPhaseSwitchAtOneTime) {
  const Mesh mesh = make_mesh(three_phases());
  const MeshNode &before = mesh.nodes[7], &after = mesh.nodes[8];
  EXPECT_EQ(before.phase, 0);
  EXPECT_EQ(after.phase, 1);
  EXPECT_EQ(before.time, after.time);
  EXPECT_EQ(before.h_out, 0.0);
  EXPECT_EQ(after.h_in, 0.0);
}

TEST(Mesh, FindsEveryNode) {
  const Mesh mesh = make_mesh(three_phases());
  for (int k = 0; k < mesh.size(); ++k) {
    const MeshNode& node = mesh.nodes[k];
    EXPECT_EQ(mesh.index({node.phase, node.node}), k);
  }
}

}  // namespace
}  // namespace prowl

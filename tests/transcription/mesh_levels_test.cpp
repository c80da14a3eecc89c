#include "prowl/mesh/mesh_levels.hpp"

#include <gmock/gmock.h>

#include "../support/robots.hpp"
#include "prowl/transcription/mesh.hpp"

namespace prowl {
namespace {

MotionProblem with_intervals(std::vector<int> intervals) {
  MotionProblem problem{.robot = test::hyq()};
  for (const int count : intervals) problem.phases.push_back({.name = "p", .duration = {1.0, 1.0}, .intervals = count});
  return problem;
}

std::vector<std::vector<int>> intervals_of_levels(const MotionProblem& problem) {
  std::vector<std::vector<int>> levels;
  for (const MotionProblem& level : mesh_levels(problem)) {
    levels.emplace_back();
    for (const Phase& phase : level.phases) levels.back().push_back(phase.intervals);
  }
  return levels;
}

using testing::ElementsAre;

TEST(MeshLevels, GoFromCoarseToFineByFour) {
  EXPECT_THAT(intervals_of_levels(with_intervals({400})),
              ElementsAre(ElementsAre(25), ElementsAre(100), ElementsAre(400)));
}

TEST(MeshLevels, KeepFourIntervalsAPhase) {
  EXPECT_THAT(intervals_of_levels(with_intervals({3, 210})),
              ElementsAre(ElementsAre(3, 14), ElementsAre(3, 53), ElementsAre(3, 210)));
}

TEST(MeshLevels, LeaveOutWhatSavesLittle) {
  EXPECT_THAT(intervals_of_levels(with_intervals({48})), ElementsAre(ElementsAre(48)));
  EXPECT_THAT(intervals_of_levels(with_intervals({49})), ElementsAre(ElementsAre(13), ElementsAre(49)));
  EXPECT_THAT(intervals_of_levels(with_intervals(std::vector<int>(13, 7))), ElementsAre(std::vector<int>(13, 7)));
}

TEST(MeshLevels, KeepEveryGoalAtItsTime) {
  MotionProblem problem = with_intervals({40, 360});
  for (const NodeRef at : {NodeRef{0, 0}, NodeRef{1, 120}, NodeRef{1, 180}, NodeRef{1, 360}}) {
    problem.boundary_conditions.push_back(
        BoundaryCondition::unbounded(problem.robot, "goal", at, problem.robot.nominal_configuration()));
  }
  const std::vector<MotionProblem> levels = mesh_levels(problem);
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0].phases[1].intervals, 24);  // 23 are a quarter of 90, and it takes a multiple of six
  for (const MotionProblem& level : levels) {
    const Mesh mesh = make_mesh(level);
    for (std::size_t i = 0; i < level.boundary_conditions.size(); ++i) {
      const double times[] = {0.0, 1.0 + 1.0 / 3.0, 1.5, 2.0};
      EXPECT_NEAR(mesh.nodes[mesh.index(level.boundary_conditions[i].at)].time, times[i], 1e-12);
    }
  }
}

TEST(MeshLevels, KeepWhereAMeshIsFine) {
  MotionProblem problem = with_intervals({160});
  std::vector<double>& shares = problem.phases[0].shares;
  for (int i = 0; i < 160; ++i) shares.push_back(i < 80 ? 0.2 / 80.0 : 0.8 / 80.0);
  const std::vector<MotionProblem> levels = mesh_levels(problem);
  ASSERT_EQ(levels.size(), 2u);
  const Phase& coarse = levels[0].phases[0];
  ASSERT_EQ(coarse.intervals, 40);
  for (int i = 0; i < 40; ++i) EXPECT_NEAR(coarse.step(i, 1.0), i < 20 ? 0.01 : 0.04, 1e-12) << i;
}

}  // namespace
}  // namespace prowl

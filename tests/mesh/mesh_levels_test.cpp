#include "prowl/mesh/mesh_levels.hpp"

#include <gmock/gmock.h>

#include "prowl/mesh/discrete_problem.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using test::MeshedProblem;

MeshedProblem with_intervals(const std::vector<int>& intervals) {
  MeshedProblem of{.problem = {.robot = test::hyq()}, .mesh = {}};
  for (const int count : intervals) {
    of.problem.phases.push_back({.name = "p", .contacts = {}, .duration = {1.0, 1.0}});
    of.mesh.phases.emplace_back(count);
  }
  return of;
}

std::vector<std::vector<int>> intervals_of_levels(const MeshedProblem& of) {
  std::vector<std::vector<int>> levels;
  for (const Mesh& level : mesh_levels(of.problem, of.mesh)) levels.push_back(test::intervals_of(level));
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
  auto [problem, mesh] = with_intervals({40, 360});
  for (const PhaseFraction at : {PhaseFraction{0, 0.0}, PhaseFraction{1, 120.0 / 360.0},
                                 PhaseFraction{1, 180.0 / 360.0}, PhaseFraction{1, 1.0}}) {
    problem.boundary_constraints.push_back(
        BoundaryConstraint::unbounded(problem.robot, "goal", at, problem.robot.nominal_configuration()));
  }
  const std::vector<Mesh> levels = mesh_levels(problem, mesh);
  ASSERT_EQ(levels.size(), 3u);
  EXPECT_EQ(levels[0].phases[1].intervals(), 24);  // 23 are a quarter of 90, and it takes a multiple of six
  for (const Mesh& level : levels) {
    const std::vector<int> nodes = find_boundary_nodes(problem, level);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double times[] = {0.0, 1.0 + 1.0 / 3.0, 1.5, 2.0};
      const int phase = problem.boundary_constraints[i].at.phase, node = nodes[i] - level.first_node(phase);
      EXPECT_NEAR(phase + level.phases[phase].node_time(node, 1.0), times[i], 1e-12);
    }
  }
}

TEST(MeshLevels, KeepWhereAMeshIsFine) {
  MeshedProblem of = with_intervals({160});
  std::vector<double> shares;
  for (int i = 0; i < 160; ++i) shares.push_back(i < 80 ? 0.2 / 80.0 : 0.8 / 80.0);
  of.mesh.phases = {PhaseMesh(shares)};
  const std::vector<Mesh> levels = mesh_levels(of.problem, of.mesh);
  ASSERT_EQ(levels.size(), 2u);
  const PhaseMesh& coarse = levels[0].phases[0];
  ASSERT_EQ(coarse.intervals(), 40);
  for (int i = 0; i < 40; ++i) EXPECT_NEAR(coarse.step(i, 1.0), i < 20 ? 0.01 : 0.04, 1e-12) << i;
}

}  // namespace
}  // namespace prowl

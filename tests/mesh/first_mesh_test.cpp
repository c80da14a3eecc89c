#include "prowl/mesh/first_mesh.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <random>

#include "tests/support/meshed_problem.hpp"

namespace prowl {
namespace {

using testing::ElementsAre;

Phase lasting(double seconds) { return {.duration = {seconds, seconds}}; }

TEST(FirstMesh, HasEqualIntervalsAtItsRate) {
  EXPECT_THAT(test::intervals_of(first_mesh({lasting(2.0), lasting(0.3), lasting(0.65)}, {})), ElementsAre(20, 4, 7));
  EXPECT_TRUE(first_mesh({lasting(2.0)}, {}).is_even());
  EXPECT_THAT(test::intervals_of(first_mesh({{.duration = {0.5, 1.5}}}, {})), ElementsAre(15)) << "at its longest";
}

TEST(FirstMesh, HasANodeAtEachGoalAndStepsThatContactsAllow) {
  std::mt19937 rng(1);
  std::uniform_real_distribution<double> fraction(0.0, 1.0), seconds(0.05, 3.0);
  for (int repeat = 0; repeat < 200; ++repeat) {
    const std::vector<Phase> phases = {lasting(seconds(rng)), lasting(seconds(rng))};
    std::vector<PhaseFraction> goals = {{0, 0.0}, {1, 1.0}};
    for (int i = 0; i < 4; ++i) goals.push_back({i % 2, fraction(rng) * fraction(rng)});
    const Mesh mesh = first_mesh(phases, goals);
    for (const PhaseFraction& goal : goals) {
      EXPECT_TRUE(mesh.phases[goal.phase].node_at(goal.fraction)) << goal.fraction;
    }
    for (std::size_t p = 0; p < phases.size(); ++p) {
      const PhaseMesh& phase = mesh.phases[p];
      EXPECT_GE(phase.intervals(), kFewestFirst);
      for (int i = 0; i < phase.intervals(); ++i) {
        EXPECT_LE(phase.step(i, phases[p].duration.max), (1.0 + 1e-6) / kFirstRate);
        if (i > 0) EXPECT_LE(phase.step(i, 1.0), (kMostGrowth + 1e-6) * phase.step(i - 1, 1.0));
      }
    }
  }
}

TEST(FirstMesh, GrowsFromAGoalSoonAfterAPhaseBegins) {
  const Mesh mesh = first_mesh({lasting(1.0)}, {{0, 0.001}});
  EXPECT_LE(mesh.num_intervals(), 10 + 5) << "1, 4, 16, 64 ms";
}

/// One time, as a fraction and from seconds: 0.5 and a little more, by rounding.
TEST(FirstMesh, HasOneNodeForOneMoment) {
  const std::vector<Phase> phases = {{.name = "stand", .contacts = {}, .duration = {0.8, 0.8}}};
  const double rounded = std::nextafter(0.5, 1.0);
  EXPECT_EQ(first_mesh(phases, {{0, 0.5}, {0, rounded}}), first_mesh(phases, {{0, 0.5}}));
}

TEST(FirstMesh, IsSplitIntoEqualPieces) {
  const Mesh mesh = first_mesh({lasting(0.4), lasting(1.0)}, {{1, 0.37}}), halves = split(mesh, 2);
  ASSERT_EQ(halves.num_intervals(), 2 * mesh.num_intervals());
  EXPECT_TRUE(halves.phases[0].is_even());
  for (int i = 0; i < halves.phases[1].intervals(); ++i) {
    EXPECT_NEAR(halves.phases[1].step(i, 1.0), 0.5 * mesh.phases[1].step(i / 2, 1.0), 1e-12);
  }
}

}  // namespace
}  // namespace prowl

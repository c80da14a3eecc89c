#include "prowl/mesh/mesh.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "prowl/error.hpp"
#include "prowl/motion/gait.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::IsEmpty;
using testing::Pointwise;
using testing::StartsWith;

std::vector<double> steps(const PhaseMesh& mesh, double duration = 1.0) {
  std::vector<double> steps;
  for (int i = 0; i < mesh.intervals(); ++i) steps.push_back(mesh.step(i, duration));
  return steps;
}

TEST(PhaseMesh, CutsAPhaseIntoEqualSteps) {
  const PhaseMesh mesh(7);
  EXPECT_EQ(mesh.intervals(), 7);
  EXPECT_TRUE(mesh.is_even());
  EXPECT_THAT(steps(mesh, 0.7), Pointwise(DoubleNear(1e-15), std::vector<double>(7, 0.1)));
  for (int k = 0; k <= 7; ++k) EXPECT_NEAR(mesh.node_time(k, 0.7), 0.1 * k, 1e-15);
  EXPECT_EQ(mesh.node_time(7, 0.7), 0.7);
}

TEST(PhaseMesh, LengthsAreProportions) {
  const PhaseMesh mesh({2.0, 6.0});
  EXPECT_EQ(mesh.intervals(), 2);
  EXPECT_FALSE(mesh.is_even());
  EXPECT_THAT(mesh.shares(), ElementsAre(0.25, 0.75));
  EXPECT_EQ(mesh.node_time(1, 2.0), 0.5);
  EXPECT_EQ(mesh.node_time(2, 0.7), 0.7) << "the end of the phase, exactly";
  EXPECT_THAT(PhaseMesh({3.0, 3.0, 3.0}).shares(), IsEmpty());
  EXPECT_EQ(PhaseMesh({3.0, 3.0, 3.0}).intervals(), 3);
}

/// Written to a file and read again, they are the same mesh.
TEST(PhaseMesh, SharesAreKeptToTheLastBit) {
  const PhaseMesh mesh({0.3, 0.7, 1.1});
  EXPECT_EQ(PhaseMesh(mesh.shares()).shares(), mesh.shares());
}

TEST(PhaseMesh, RefusesWhatCutsNothing) {
  const auto message = [](const std::vector<double>& lengths) -> std::string {
    try {
      PhaseMesh{lengths};
    } catch (const InputError& error) {
      return error.what();
    }
    return "accepted";
  };
  EXPECT_EQ(message({0.4, 0.6}), "accepted");
  EXPECT_EQ(message({}), "intervals: 0 is not allowed; need 1 or more");
  EXPECT_EQ(message({0.4, 0.0}), "shares[1]: 0 is not allowed; need a part of the phase, > 0");
  EXPECT_THAT(message({-0.4, 1.4}), StartsWith("shares[0]: -0.4 is not allowed"));
  EXPECT_THAT(message({0.4, std::numeric_limits<double>::quiet_NaN()}), StartsWith("shares[1]: nan"));
  EXPECT_THAT(message({std::numeric_limits<double>::infinity(), 0.4}), StartsWith("shares[0]: inf"));
  for (const int intervals : {0, -1}) EXPECT_THROW(PhaseMesh{intervals}, InputError) << intervals;
}

TEST(PhaseMesh, FindsANodeByThePartOfThePhaseThatIsOver) {
  const PhaseMesh even(360), uneven({0.1, 0.1, 0.3, 0.5});
  for (int k = 0; k <= 360; ++k) EXPECT_EQ(even.node_at(1.0 * k / 360), k);
  EXPECT_EQ(even.node_at(0.5 / 360), std::nullopt);
  EXPECT_EQ(uneven.node_at(0.0), 0);
  EXPECT_EQ(uneven.node_at(0.2), 2);
  EXPECT_EQ(uneven.node_at(0.5), 3);
  EXPECT_EQ(uneven.node_at(0.5 + 1e-12), 3) << "up to rounding";
  EXPECT_EQ(uneven.node_at(1.0), 4);
  EXPECT_EQ(uneven.node_at(0.25), std::nullopt);
}

TEST(PhaseMesh, AnEqualMeshStaysEqual) {
  const PhaseMesh mesh = PhaseMesh(4).with_intervals(7);
  EXPECT_EQ(mesh.intervals(), 7);
  EXPECT_THAT(mesh.shares(), IsEmpty());
}

TEST(PhaseMesh, AnUnevenMeshKeepsItsDensity) {
  const PhaseMesh mesh({0.1, 0.1, 0.3, 0.5});
  EXPECT_THAT(steps(mesh.with_intervals(4)), Pointwise(DoubleNear(1e-15), mesh.shares()));
  EXPECT_THAT(steps(mesh.with_intervals(8)),
              Pointwise(DoubleNear(1e-15), {0.05, 0.05, 0.05, 0.05, 0.15, 0.15, 0.25, 0.25}));
  EXPECT_THAT(steps(mesh.with_intervals(2)), Pointwise(DoubleNear(1e-15), {0.2, 0.8}));
  // Nodes where 4/3 and 8/3 of the old intervals are over.
  EXPECT_THAT(steps(mesh.with_intervals(3)), Pointwise(DoubleNear(1e-15), {0.4 / 3.0, 0.8 / 3.0, 0.6}));
}

TEST(Mesh, CountsTheNodesOfAllPhasesInOrder) {
  const Mesh mesh{{PhaseMesh(7), PhaseMesh({0.5, 0.2, 0.3}), PhaseMesh(1)}};
  EXPECT_EQ(mesh.num_intervals(), 7 + 3 + 1);
  EXPECT_EQ(mesh.num_nodes(), 8 + 4 + 2);
  int node = 0;
  for (int p = 0; p < 3; ++p) {
    EXPECT_EQ(mesh.first_node(p), node);
    for (int k = 0; k <= mesh.phases[p].intervals(); ++k) EXPECT_EQ(mesh.node(p, k), node++);
    EXPECT_EQ(mesh.last_node(p), node - 1);
  }
  EXPECT_FALSE(mesh.is_even());
  EXPECT_TRUE((Mesh{{PhaseMesh(7), PhaseMesh(1)}}).is_even());
}

TEST(MeshWithRate, IsNoCoarserThanAskedFor) {
  const RobotModel robot = test::hyq();
  Gait gait{.pattern = gait_pattern("walk"), .strides = 2, .stride = {0.8, 0.8}};
  gait.duty_factor = gait.pattern.slow_duty_factor;
  const std::vector<Phase> phases = expand(gait, robot, *find_feet(robot));
  const Mesh mesh = mesh_with_rate(phases, 30.0);
  ASSERT_EQ(mesh.phases.size(), phases.size());
  EXPECT_TRUE(mesh.is_even());
  for (std::size_t p = 0; p < phases.size(); ++p) {
    const double asked = phases[p].duration.max * 30.0;
    EXPECT_GE(mesh.phases[p].intervals(), asked - 1e-9) << phases[p].name;
    EXPECT_LE(mesh.phases[p].intervals(), std::max(2.0, asked + 1.0)) << phases[p].name;
    EXPECT_GE(mesh.phases[p].intervals(), 2) << phases[p].name;
  }
  EXPECT_THAT(test::intervals_of(mesh_with_rate({{.duration = {0.3, 0.3}}}, 50.0)), ElementsAre(15))
      << "rounding makes no interval";
}

}  // namespace
}  // namespace prowl

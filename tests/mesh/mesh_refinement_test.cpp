#include "prowl/mesh/mesh_refinement.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <random>

#include "prowl/mesh/discrete_problem.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using testing::DoubleNear;
using testing::ElementsAre;
using testing::Pointwise;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One phase of a second in so many equal intervals, with goals at these nodes.
test::MeshedProblem one_phase(int intervals, const std::vector<int>& goals = {}) {
  MotionProblem problem{.robot = test::hyq()};
  problem.phases = {{.name = "p", .contacts = {}, .duration = {1.0, 1.0}}};
  for (const int node : goals) {
    problem.boundary_constraints.push_back(BoundaryConstraint::unbounded(
        problem.robot, "goal", {0, 1.0 * node / intervals}, problem.robot.nominal_configuration()));
  }
  return {std::move(problem), {{PhaseMesh(intervals)}}};
}

std::vector<double> steps(const Mesh& mesh, std::size_t phase = 0) {
  std::vector<double> steps;
  const PhaseMesh& of = mesh.phases[phase];
  for (int i = 0; i < of.intervals(); ++i) steps.push_back(of.step(i, 1.0));
  return steps;
}

TEST(MeshRefinement, SplitsIntoWhatAnErrorOfFourthOrderTakes) {
  // A step of a half leaves a sixteenth, and two thirds are aimed at: 10 * 1.5 < 16 = 2^4 < 11 * 1.5 < 81 = 3^4 < 60
  // * 1.5.
  const Mesh mesh = refined(one_phase(6).mesh, {0.5, 10.0, 11.0, 60.0, 1e9, kInfinity});
  std::vector<double> expected = {1.0, 0.5, 0.5};
  expected.insert(expected.end(), 3, 1.0 / 3.0);
  expected.insert(expected.end(), 12, 0.25);
  for (double& step : expected) step /= 6.0;
  EXPECT_THAT(steps(mesh), Pointwise(DoubleNear(1e-12), expected));
}

/// With an error of K h⁴, the largest of any mesh that it asks for is within the tolerance, and K may differ a
/// thousandfold.
TEST(MeshRefinement, MeetsTheToleranceOfASmoothMotion) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> exponent(0.0, 3.0);
  test::MeshedProblem of = one_phase(40);
  std::vector<double> K(40);
  for (double& k : K) k = std::pow(10.0, 6.0 + exponent(rng));
  const auto parts_on = [&](const Mesh& on) {
    std::vector<double> parts;
    double time = 0.0;
    for (const double h : steps(on)) {
      const auto from = static_cast<std::size_t>(40.0 * (time + 1e-9)),
                 to = static_cast<std::size_t>(40.0 * (time + h - 1e-9));
      const double k = *std::max_element(K.begin() + static_cast<long>(from), K.begin() + static_cast<long>(to) + 1);
      parts.push_back(k * std::pow(h, 4));
      time += h;
    }
    return parts;
  };
  int rounds = 0;
  std::vector<double> parts = parts_on(of.mesh);
  ASSERT_GT(*std::ranges::max_element(parts), 256.0) << "more than one round";
  for (; *std::ranges::max_element(parts) > 1.0; parts = parts_on(of.mesh)) {
    ASSERT_LT(++rounds, 4);
    of.mesh = refined(of.mesh, parts);
  }
  EXPECT_LT(of.mesh.num_intervals(), std::pow(1e9, 0.25)) << "as many equal ones as the largest K takes";
}

TEST(MeshRefinement, SplitsEachPhaseByItself) {
  test::MeshedProblem two = one_phase(6);
  two.mesh.phases.emplace_back(2);
  const Mesh mesh = refined(two.mesh, {0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.9, 0.0});
  EXPECT_THAT(steps(mesh, 0),
              Pointwise(DoubleNear(1e-12), {1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 12.0, 1 / 12.0}));
  EXPECT_THAT(steps(mesh, 1), Pointwise(DoubleNear(1e-12), {0.25, 0.25, 0.5}));
}

TEST(MeshRefinement, GoalsKeepTheirNodes) {
  test::MeshedProblem of = one_phase(20, {0, 5, 20});
  std::vector<double> parts(20, 0.0);
  parts[2] = parts[11] = 20.0;
  of.mesh = refined(of.mesh, parts);
  EXPECT_THAT(find_boundary_nodes(of.problem, of.mesh), ElementsAre(0, 7, 24));
}

/// The gains of contacts are good for steps that grow by up to four.
TEST(MeshRefinement, StepsGrowByAtMostFour) {
  test::MeshedProblem of = one_phase(3);
  of.mesh.phases = {PhaseMesh({0.02, 0.18, 0.8})};
  EXPECT_THAT(steps(refined(of.mesh, {0.5, 0.5, 0.5})),
              Pointwise(DoubleNear(1e-12), {0.02, 0.06, 0.06, 0.06, 0.2, 0.2, 0.2, 0.2}));
  of.mesh.phases = {PhaseMesh({0.8, 0.18, 0.02})};
  EXPECT_THAT(steps(refined(of.mesh, {0.5, 0.5, 0.5})), testing::SizeIs(3)) << "they may shrink";
}

TEST(MeshRefinement, LeavesAMeshThatIsRight) {
  test::MeshedProblem of = one_phase(4);
  of.mesh.phases = {PhaseMesh({0.1, 0.2, 0.3, 0.4})};
  EXPECT_THAT(steps(refined(of.mesh, {0.3, 0.6, 0.5, 0.4})), Pointwise(DoubleNear(1e-15), {0.1, 0.2, 0.3, 0.4}));
}

}  // namespace
}  // namespace prowl

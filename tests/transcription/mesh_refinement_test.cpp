#include "prowl/mesh/mesh_refinement.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include "../support/robots.hpp"
#include "prowl/transcription/mesh.hpp"

namespace prowl {
namespace {

using testing::DoubleNear;
using testing::Each;
using testing::ElementsAre;
using testing::Pointwise;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// One phase of a second in so many equal intervals, with goals at these nodes.
MotionProblem one_phase(int intervals, const std::vector<int>& goals = {}) {
  MotionProblem problem{.robot = test::hyq()};
  problem.phases = {{.name = "p", .duration = {1.0, 1.0}, .intervals = intervals}};
  for (const int node : goals) {
    problem.boundary_conditions.push_back(
        BoundaryCondition::unbounded(problem.robot, "goal", {0, node}, problem.robot.nominal_configuration()));
  }
  return problem;
}

std::vector<double> steps(const MotionProblem& problem, std::size_t phase = 0) {
  std::vector<double> steps;
  const Phase& of = problem.phases[phase];
  for (int i = 0; i < of.intervals; ++i) steps.push_back(of.step(i, 1.0));
  return steps;
}

Certificate with_errors(const std::vector<double>& local, double reintegration, double second) {
  Certificate certificate;
  for (const double error : local) {
    certificate.interval_errors.push_back({.error = error, .where = "", .reintegration = reintegration});
  }
  certificate.checks = {{"local integration error", *std::ranges::max_element(local)},
                        {"integration error in a second", second},
                        {"re-integration", reintegration}};
  return certificate;
}

TEST(MeshRefinement, SplitsIntoWhatTheOrderOfTheTrapezoidTakes) {
  // A step of a half leaves an eighth, and two thirds are aimed at: 5 * 1.5 < 8 = 2^3 < 6 * 1.5 < 27 = 3^3 < 20 * 1.5.
  const MotionProblem problem = refined(one_phase(6), {0.5, 5.0, 6.0, 20.0, 1e9, kInfinity});
  std::vector<double> expected = {1.0, 0.5, 0.5};
  expected.insert(expected.end(), 3, 1.0 / 3.0);
  expected.insert(expected.end(), 12, 0.25);
  for (double& step : expected) step /= 6.0;
  EXPECT_THAT(steps(problem), Pointwise(DoubleNear(1e-12), expected));
}

/// With an error of K h³, the largest of any mesh that it asks for is within the tolerance, and K may differ a
/// thousandfold.
TEST(MeshRefinement, MeetsTheToleranceOfASmoothMotion) {
  std::mt19937 rng(3);
  std::uniform_real_distribution<double> exponent(0.0, 3.0);
  MotionProblem problem = one_phase(40);
  std::vector<double> K(40);
  for (double& k : K) k = std::pow(10.0, 4.0 + exponent(rng));
  const auto parts_on = [&](const MotionProblem& on) {
    std::vector<double> parts;
    double time = 0.0;
    for (const double h : steps(on)) {
      const auto from = static_cast<std::size_t>(40.0 * (time + 1e-9)),
                 to = static_cast<std::size_t>(40.0 * (time + h - 1e-9));
      const double k = *std::max_element(K.begin() + static_cast<long>(from), K.begin() + static_cast<long>(to) + 1);
      parts.push_back(k * h * h * h);
      time += h;
    }
    return parts;
  };
  int rounds = 0;
  std::vector<double> parts = parts_on(problem);
  ASSERT_GT(*std::ranges::max_element(parts), 64.0) << "more than one round";
  for (; *std::ranges::max_element(parts) > 1.0; parts = parts_on(problem)) {
    ASSERT_LT(++rounds, 4);
    problem = refined(problem, parts);
  }
  EXPECT_LT(problem.phases[0].intervals, 40.0 * std::cbrt(1e7 / 64e3)) << "as many equal ones as the largest K takes";
}

TEST(MeshRefinement, MergesWhatIsFarBelow) {
  // Two as one are off by eight times as much, three by 27 times, four by 64; a quarter of the tolerance is allowed.
  EXPECT_THAT(steps(refined(one_phase(12), std::vector<double>(12, 0.25 / 7.9))), testing::SizeIs(12));
  EXPECT_THAT(steps(refined(one_phase(12), std::vector<double>(12, 0.25 / 8.1))), testing::SizeIs(6));
  EXPECT_THAT(steps(refined(one_phase(12), std::vector<double>(12, 0.25 / 27.1))), testing::SizeIs(4));
  EXPECT_THAT(steps(refined(one_phase(40), std::vector<double>(40, 0.0))), testing::SizeIs(10)) << "four at most";
  EXPECT_THAT(steps(refined(one_phase(8), std::vector<double>(8, 0.0))), testing::SizeIs(4))
      << "a quarter of the phase at most";
  EXPECT_THAT(steps(refined(one_phase(3), std::vector<double>(3, 0.0))), testing::SizeIs(3));
}

TEST(MeshRefinement, DoesNotMergeOverAGoalNorOverAPhaseSwitch) {
  const MotionProblem problem = refined(one_phase(20, {0, 5, 20}), std::vector<double>(20, 0.0));
  EXPECT_THAT(steps(problem), Pointwise(DoubleNear(1e-12), {0.2, 0.05, 0.2, 0.2, 0.2, 0.15}));
  std::vector<int> nodes;
  for (const BoundaryCondition& goal : problem.boundary_conditions) nodes.push_back(goal.at.node);
  EXPECT_THAT(nodes, ElementsAre(0, 2, 6));

  MotionProblem two = one_phase(6);
  two.phases.push_back({.name = "q", .duration = {0.2, 0.5}, .intervals = 2});
  two = refined(two, {0.0, 0.0, 0.0, 0.0, 0.0, 2.0, 0.9, 0.0});
  EXPECT_THAT(steps(two, 0),
              Pointwise(DoubleNear(1e-12), {1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 6.0, 1 / 12.0, 1 / 12.0}));
  EXPECT_THAT(steps(two, 1), Pointwise(DoubleNear(1e-12), {0.25, 0.25, 0.5}));
}

/// The gains of contacts are good for steps that grow by up to four.
TEST(MeshRefinement, StepsGrowByAtMostFour) {
  MotionProblem problem = one_phase(3);
  problem.phases[0].shares = {0.02, 0.18, 0.8};
  EXPECT_THAT(steps(refined(problem, {0.5, 0.5, 0.5})),
              Pointwise(DoubleNear(1e-12), {0.02, 0.06, 0.06, 0.06, 0.2, 0.2, 0.2, 0.2}));
  problem.phases[0].shares = {0.8, 0.18, 0.02};
  EXPECT_THAT(steps(refined(problem, {0.5, 0.5, 0.5})), testing::SizeIs(3)) << "they may shrink";
}

TEST(MeshRefinement, LeavesAMeshThatIsRight) {
  MotionProblem problem = one_phase(4);
  problem.phases[0].shares = {0.1, 0.2, 0.3, 0.4};
  EXPECT_THAT(steps(refined(problem, {0.3, 0.6, 0.5, 0.4})), Pointwise(DoubleNear(1e-15), {0.1, 0.2, 0.3, 0.4}));
}

TEST(ErrorParts, AreTheLargerOfBothErrors) {
  const MeshTolerance tolerance{.local = 1e-4, .second = 1.0, .reintegration = 5e-4};
  EXPECT_THAT(error_parts(with_errors({2e-4, 1e-5}, 3e-4, 0.0), tolerance), Pointwise(DoubleNear(1e-12), {2.0, 0.6}));
  EXPECT_THAT(error_parts(with_errors({2e-4, 1e-5}, 3e-3, 0.0), tolerance), Pointwise(DoubleNear(1e-12), {6.0, 6.0}));
  EXPECT_THAT(error_parts(with_errors({std::nan(""), kInfinity}, 0.0, 0.0), tolerance), Each(kInfinity));
}

/// A mesh that meets the sum over a second is not made coarser than the sum allows: it would be split again.
TEST(ErrorParts, KeepTheSumWhereMeshesMerge) {
  const MeshTolerance tolerance{.local = 1e-4, .second = 3e-3, .reintegration = 5e-4};
  const int n = 100;
  const double e = 0.9 * tolerance.second / n;
  const double c = e / error_parts(with_errors(std::vector<double>(n, e), 0.0, n * e), tolerance)[0];
  EXPECT_NEAR(n * std::cbrt(e / c) * c, tolerance.second, 1e-12);
  EXPECT_LT(c, 0.5 * tolerance.local);
  EXPECT_EQ(error_parts(with_errors({0.0, 0.0}, 0.0, 0.0), tolerance)[0], 0.0);
}

/// Where only the sum is too large, intervals have to be off by less than the worst is, so that the sum of equal errors
/// is right: n intervals of error e become n (e/c)^(1/3) of error c.
TEST(ErrorParts, KeepTheSumOverASecond) {
  const MeshTolerance tolerance{.local = 1e-4, .second = 3e-3, .reintegration = 5e-4};
  const double e = 0.8e-4;
  const int n = 100;
  const std::vector<double> parts = error_parts(with_errors(std::vector<double>(n, e), 0.0, n * e), tolerance);
  const double c = e / parts[0];
  EXPECT_NEAR(n * std::cbrt(e / c) * c, tolerance.second, 1e-12);
  // As long as intervals are too coarse themselves, the sum tells nothing of what is left of it.
  EXPECT_NEAR(error_parts(with_errors({2e-4, e}, 0.0, 1.0), tolerance)[1], 0.8, 1e-12);
}

TEST(MeshTolerance, IsWhatTheGradesAskFor) {
  const MeshTolerance draft = mesh_tolerance(Grade::draft), certified = mesh_tolerance(Grade::certified);
  EXPECT_EQ(draft.local, CertificateLimits::integration_error_draft);
  EXPECT_EQ(certified.second, CertificateLimits::second_error_certified);
  for (const MeshTolerance& of_grade : {draft, certified}) {
    const MeshTolerance same = mesh_tolerance(of_grade.reintegration);
    EXPECT_DOUBLE_EQ(same.local, of_grade.local);
    EXPECT_EQ(same.second, of_grade.second);
  }
  EXPECT_DOUBLE_EQ(mesh_tolerance(5e-5).local, 1e-5);
  EXPECT_EQ(mesh_tolerance(5e-5).second, draft.second);
}

}  // namespace
}  // namespace prowl

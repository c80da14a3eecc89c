#include "prowl/elastic/elastic_solve.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

std::function<bool(const MotionLimit&)> only(LimitKind kind) {
  return [kind](const MotionLimit& limit) { return limit.kind == kind; };
}

DiscreteProblem on_slope(double degrees, double friction) {
  MotionProblem problem =
      test::with_base_goal(test::standing_problem(test::hyq(), degrees, friction), Eigen::Vector3d::Zero());
  problem.running_cost.acceleration_weight.setOnes();
  BoundaryConstraint& goal = problem.boundary_constraints.back();
  goal.velocity_lower.head<6>().setZero();
  goal.velocity_upper.head<6>().setZero();
  return test::on_even_mesh(std::move(problem), 8);
}

/// From rest to rest at the same place the mean force is the weight, so that along the slope at least W (sin α - µ cos
/// α) is missing on average, whatever the motion. Sizes are µ W.
TEST(ElasticSolve, FindsTheFrictionThatIsMissingOnASlope) {
  const double angle = 20.0 * kDegree, friction = 0.3;
  const ElasticResult result =
      elastic_solve(on_slope(20.0, friction), IpoptSolver(), {.tolerance = 1e-6}, only(LimitKind::friction));
  ASSERT_EQ(result.status, SolveStatus::converged);
  ASSERT_FALSE(result.breaches.empty());
  double total = 0.0;
  for (const Breach& breach : result.breaches) {
    EXPECT_EQ(breach.kind, LimitKind::friction);
    EXPECT_EQ(breach.unit, "N");
    EXPECT_THAT(breach.subject, testing::HasSubstr("_foot"));
    EXPECT_GT(breach.amount, 0.0);
    total += breach.total;
  }
  const double missing = (std::sin(angle) - friction * std::cos(angle)) / friction;
  EXPECT_GT(total, 0.99 * missing);
  EXPECT_LT(total, 1.15 * missing) << "the cones' smoothed tips ask for a little more";
}

TEST(ElasticSolve, FindsNothingWhereNothingIsMissing) {
  const ElasticResult result = elastic_solve(on_slope(10.0, 0.5), IpoptSolver(), {.tolerance = 1e-6});
  EXPECT_EQ(result.status, SolveStatus::converged);
  EXPECT_TRUE(result.breaches.empty());
}

/// A goal that no leg reaches gives way by what lengths say, and nothing else does.
TEST(ElasticSolve, FindsHowFarAGoalIsOutOfReach) {
  MotionProblem high = test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.4});
  high.running_cost.acceleration_weight.setOnes();
  const ElasticResult result =
      elastic_solve(test::on_even_mesh(high, 8), IpoptSolver(), {.tolerance = 1e-6}, only(LimitKind::goal));
  ASSERT_EQ(result.status, SolveStatus::converged);
  ASSERT_EQ(result.breaches.size(), 1u);
  EXPECT_EQ(result.breaches.front().subject, high.boundary_constraints.back().name + ", base z");
  EXPECT_EQ(result.breaches.front().time, 2.0);
  EXPECT_GT(result.breaches.front().amount, 0.2) << "HyQ's base is 0.60 m high and its legs stretch to 0.75 m or so";
  EXPECT_LT(result.breaches.front().amount, 0.35);
}

/// The initial mesh has the middle of a range; what the optimiser makes of it is another motion.
TEST(ElasticSolve, TellsTimesOfItsOwnMotion) {
  MotionProblem high = test::with_base_goal(test::standing_problem(), {0.0, 0.0, 0.4});
  high.running_cost.acceleration_weight.setOnes();
  high.phases.front().duration = {1.0, 3.0};
  const ElasticResult result =
      elastic_solve(test::on_even_mesh(high, 8), IpoptSolver(), {.tolerance = 1e-6}, only(LimitKind::goal));
  ASSERT_EQ(result.status, SolveStatus::converged);
  ASSERT_EQ(result.breaches.size(), 1u);
  EXPECT_NEAR(result.breaches.front().time, 3.0, 0.05) << "the slower the less it accelerates";
}

}  // namespace
}  // namespace prowl

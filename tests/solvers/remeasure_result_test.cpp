// What a solver claims is held against the point that it gives.
#include "prowl/solvers/remeasure_result.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using test::Hs071;
using ::testing::HasSubstr;

constexpr double kTolerance = 1e-6;

/// A point within all constraints of the problem but |x|^2 = 40, which it misses by `miss`.
SolveResult claimed(SolveStatus status, double miss) {
  SolveResult result;
  result.status = status;
  result.message = "claimed";
  result.z = Eigen::Vector4d::Constant(std::sqrt((40.0 + miss) / 4.0));
  return result;
}

TEST(RemeasureResult, MeasuresAtThePointAndLeavesWhatIsTrue) {
  Hs071 nlp;
  SolveResult result = claimed(SolveStatus::converged, 0.5e-6);
  result.cost = 1e3;
  remeasure_result(nlp, kTolerance, "Solver", result);
  EXPECT_EQ(result.status, SolveStatus::converged);
  EXPECT_EQ(result.message, "claimed");
  EXPECT_DOUBLE_EQ(result.cost, nlp.cost(result.z));
  EXPECT_NEAR(result.constraint_violation, 0.5e-6, 1e-12);
}

TEST(RemeasureResult, TakesNoViolatedPointForConverged) {
  Hs071 nlp;
  SolveResult result = claimed(SolveStatus::converged, 2e-6);
  remeasure_result(nlp, kTolerance, "Solver", result);
  EXPECT_EQ(result.status, SolveStatus::solver_failed);
  EXPECT_THAT(result.message, HasSubstr("Solver reports convergence, but a constraint is not within tolerance"));
  EXPECT_NEAR(result.constraint_violation, 2e-6, 1e-12);
}

TEST(RemeasureResult, LeavesWhatDoesNotClaimToHaveConverged) {
  Hs071 nlp;
  SolveResult result = claimed(SolveStatus::iteration_limit, 1.0);
  remeasure_result(nlp, kTolerance, "Solver", result);
  EXPECT_EQ(result.status, SolveStatus::iteration_limit);
  EXPECT_EQ(result.message, "claimed");
  EXPECT_NEAR(result.constraint_violation, 1.0, 1e-12);
}

TEST(RemeasureResult, NamesWhatCannotBeEvaluated) {
  Hs071 nlp;
  SolveResult result = claimed(SolveStatus::converged, 0.0);
  result.z(2) = std::numeric_limits<double>::quiet_NaN();
  remeasure_result(nlp, kTolerance, "Solver", result);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("result cannot be evaluated: "));
  EXPECT_THAT(result.message, HasSubstr("variable 2"));
  EXPECT_TRUE(std::isnan(result.cost));
  EXPECT_TRUE(std::isnan(result.constraint_violation));
}

}  // namespace
}  // namespace prowl

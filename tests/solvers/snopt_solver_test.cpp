#include "prowl/solvers/foreign/snopt_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <limits>
#include <vector>

#include "prowl/error.hpp"
#include "tests/nlp/test_problems.hpp"

// The real library is commercial. PROWL_SNOPT_DOUBLE has its functions and checks what it is handed: indices, bounds,
// work space, and all derivatives against differences.
namespace prowl {
namespace {

using Eigen::Vector4d;
using test::Hs071;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Optional;

const Vector4d kOptimum(1.0, 4.74299964, 3.82114998, 1.37940829);

SolveResult solve(Nlp& nlp, const Eigen::VectorXd& guess, const SolverOptions& options = {}) {
  return SnoptSolver(PROWL_SNOPT_DOUBLE).solve(nlp, guess, options);
}

TEST(SnoptSolver, SaysWhatIsMissing) {
  Hs071 nlp;
  const SnoptSolver none("libsnopt7-that-nobody-has.so");
  EXPECT_THAT(none.why_unsupported(nlp),
              Optional(AllOf(HasSubstr("commercial"), HasSubstr("libsnopt7-that-nobody-has.so"))));
  EXPECT_THROW(none.solve(nlp, Hs071::guess(), {}), InputError);

  const SnoptSolver other("libm.so.6");
  EXPECT_THAT(other.why_unsupported(nlp),
              Optional(AllOf(HasSubstr("libm.so.6: function f_snset is missing"), HasSubstr("snopt-interface"))));
}

TEST(SnoptSolver, NamesBoundsThatLeaveNothing) {
  Hs071 nlp;
  const SnoptSolver solver(PROWL_SNOPT_DOUBLE);
  EXPECT_EQ(solver.why_unsupported(nlp), std::nullopt);
  nlp.g_lower[1] = 41.0;
  EXPECT_THAT(solver.why_unsupported(nlp), Optional(HasSubstr("constraint 1: bounds [41, 40]")));
}

TEST(SnoptSolver, HandsOverTheProgramAndReadsTheResult) {
  Hs071 nlp;
  const SolveResult result = solve(nlp, kOptimum);
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_EQ(result.z, kOptimum);
  EXPECT_NEAR(result.cost, 17.0140172892, 1e-7);
  EXPECT_LT(result.constraint_violation, 1e-6);
  EXPECT_EQ(result.iterations, 7);
  EXPECT_NEAR(result.multipliers[0], -0.55229366, 1e-12);
  EXPECT_LT(result.dual_violation, 1e-6) << "multipliers have the other sign than SNOPT's";
  EXPECT_GT(result.times.evaluation(), 0.0);
}

TEST(SnoptSolver, PassesOnThatThePointIsInfeasibleOrALimitWasReached) {
  Hs071 nlp;
  EXPECT_EQ(solve(nlp, Hs071::guess()).status, SolveStatus::infeasible);
  const SolveResult stopped = solve(nlp, Hs071::guess(), {.max_iterations = 1});
  EXPECT_EQ(stopped.status, SolveStatus::iteration_limit) << stopped.message;
  ASSERT_EQ(stopped.z.size(), 4);
  EXPECT_NEAR(stopped.constraint_violation, 12.0, 1e-4) << "the best of the points that were evaluated";
}

struct WrongSign : Hs071 {
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    Hs071::jacobian(x, values);
    values[5] = -values[5];
  }
};

TEST(SnoptSolver, TheDoubleSeesOneWrongDerivative) {
  WrongSign nlp;
  const SolveResult result = solve(nlp, kOptimum);
  EXPECT_EQ(result.status, SolveStatus::solver_failed);
  EXPECT_THAT(result.message, HasSubstr("derivatives"));
}

struct NotANumber : Hs071 {
  void constraints(const Eigen::VectorXd&, Eigen::Ref<Eigen::VectorXd> g) override { g << 30.0, NAN; }
};

TEST(SnoptSolver, SaysWhichEvaluationFailed) {
  NotANumber nlp;
  const SolveResult result = solve(nlp, kOptimum);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("constraint is nan at constraint 1"));
}

TEST(SnoptSolver, StopsWhenToldTo) {
  Hs071 nlp;
  const std::atomic<bool> interrupt = true;
  EXPECT_EQ(solve(nlp, Hs071::guess(), {.interrupt = &interrupt}).status, SolveStatus::interrupted);
  const SolveResult late = solve(nlp, Hs071::guess(), {.max_seconds = 1e-12});
  EXPECT_EQ(late.status, SolveStatus::time_limit) << late.message;
  EXPECT_EQ(late.z, Hs071::guess());
}

TEST(SnoptSolver, TellsOfEachEvaluation) {
  Hs071 nlp;
  std::vector<SolveProgress> seen;
  SolverOptions options;
  options.on_iteration = [&seen](const SolveProgress& progress) { seen.push_back(progress); };
  solve(nlp, kOptimum, options);
  ASSERT_EQ(seen.size(), 9u) << "the point and two differences for each variable";
  EXPECT_NEAR(seen.front().cost, 17.0140172892, 1e-7);
}

}  // namespace
}  // namespace prowl

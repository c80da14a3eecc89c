// Laws of the solvers that take every program.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using test::Hs071;
using ::testing::HasSubstr;

SolverOptions tight() {
  SolverOptions options;
  options.tolerance = 1e-9;
  return options;
}

class ProgramSolvers : public ::testing::TestWithParam<const char*> {
 protected:
  const std::unique_ptr<NlpSolver> solver = make_solver(GetParam());
  SolveResult solve(Nlp& nlp, const VectorXd& guess = Hs071::guess(), const SolverOptions& options = tight()) const {
    return solver->solve(nlp, guess, options);
  }
};
INSTANTIATE_TEST_SUITE_P(All, ProgramSolvers, ::testing::Values("ipopt", "ipopt-spral", "uno"), [](const auto& info) {
  std::string name = info.param;
  std::erase(name, '-');
  return name;
});

double largest(const VectorXd& v) { return v.lpNorm<Eigen::Infinity>(); }

// Optimum and multipliers of Hock, Schittkowski 1981; the multipliers follow from the KKT conditions at the optimum.
TEST_P(ProgramSolvers, FindTheOptimumOfHs071AndItsMultipliers) {
  Hs071 nlp;
  const SolveResult result = solve(nlp);
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_LT(largest(result.z - Eigen::Vector4d(1.0, 4.74299964, 3.82114998, 1.37940829)), 1e-7);
  EXPECT_NEAR(result.cost, 17.0140172892, 1e-8);
  EXPECT_LT(result.constraint_violation, 1e-8);
  EXPECT_LT(result.dual_violation, 1e-7);
  EXPECT_GT(result.iterations, 0);
  EXPECT_GT(result.times.evaluation(), 0.0);
  EXPECT_LT(result.times.evaluation(), result.seconds);

  // Where the bounds are not active, gradient f + multipliers . gradient g = 0.
  VectorXd gradient(4), jacobian(8);
  nlp.cost_gradient(result.z, gradient);
  nlp.jacobian(result.z, jacobian);
  ASSERT_EQ(result.multipliers.size(), 2);
  const VectorXd rest = gradient + result.multipliers[0] * jacobian.head(4) + result.multipliers[1] * jacobian.tail(4);
  EXPECT_LT(largest(rest.tail(3)), 1e-7);
  EXPECT_NEAR(result.multipliers[0], -0.55229366, 1e-7);
  EXPECT_NEAR(result.multipliers[1], 0.16146857, 1e-7);
}

TEST_P(ProgramSolvers, TakeTheSameStepsEveryTime) {
  Hs071 nlp;
  const SolveResult first = solve(nlp);
  const SolveResult second = solve(nlp);
  EXPECT_EQ(first.z, second.z);
  EXPECT_EQ(first.iterations, second.iterations);
}

TEST_P(ProgramSolvers, SolveInTwoThreadsAtOnce) {
  Hs071 nlp;
  const SolveResult alone = solve(nlp);
  std::vector<SolveResult> results(2);
  std::vector<std::thread> threads;
  for (SolveResult& result : results) {
    threads.emplace_back([&result, this] {
      Hs071 own;
      for (int i = 0; i < 50; ++i) result = solve(own);
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const SolveResult& result : results) EXPECT_EQ(result.z, alone.z);
}

/// Not even warnings: of fixed variables, of a problem without a solution.
TEST_P(ProgramSolvers, PrintNothing) {
  testing::internal::CaptureStdout();
  testing::internal::CaptureStderr();
  Hs071 nlp;
  solve(nlp);
  nlp.z_lower[2] = nlp.z_upper[2] = 3.0;
  solve(nlp);
  nlp.g_lower[1] = nlp.g_upper[1] = 150.0;
  solve(nlp);
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_P(ProgramSolvers, KeepFixedVariablesWhereTheyAre) {
  Hs071 nlp;
  nlp.z_lower[2] = nlp.z_upper[2] = 3.0;
  const SolveResult result = solve(nlp);
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_EQ(result.z[2], 3.0);
  EXPECT_LT(result.constraint_violation, 1e-8);
  EXPECT_GT(result.cost, 17.1) << "less freedom cannot cost less";
}

TEST_P(ProgramSolvers, SayThatAProblemIsInfeasible) {
  Hs071 nlp;
  nlp.g_lower[1] = nlp.g_upper[1] = 150.0;  // |x|^2 is at most 100
  const SolveResult result = solve(nlp);
  EXPECT_EQ(result.status, SolveStatus::infeasible) << result.message;
  EXPECT_NEAR(result.constraint_violation, 50.0, 1e-3);
}

TEST_P(ProgramSolvers, StopAtTheIterationLimitWithTheirBestIterate) {
  Hs071 nlp;
  SolverOptions options = tight();
  options.max_iterations = 3;
  std::vector<SolveProgress> seen;
  options.on_iteration = [&seen](const SolveProgress& progress) { seen.push_back(progress); };
  const SolveResult result = solve(nlp, Hs071::guess(), options);
  EXPECT_EQ(result.status, SolveStatus::iteration_limit) << result.message;
  EXPECT_EQ(result.iterations, 3);
  ASSERT_EQ(seen.size(), 4u);
  for (const SolveProgress& progress : seen)
    EXPECT_LE(result.constraint_violation, progress.constraint_violation + 1e-8);
  ASSERT_EQ(result.z.size(), 4);
}

TEST_P(ProgramSolvers, ReportEveryIterationInUnitsOfTheProblem) {
  Hs071 nlp;
  SolverOptions options = tight();
  std::vector<SolveProgress> seen;
  options.on_iteration = [&seen](const SolveProgress& progress) { seen.push_back(progress); };
  const SolveResult result = solve(nlp, Hs071::guess(), options);
  ASSERT_EQ(seen.size(), static_cast<size_t>(result.iterations) + 1);
  for (size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i].iteration, static_cast<int>(i));
  // |x|^2 = 52 at the start instead of 40; Ipopt moves it a little off the bounds.
  EXPECT_GT(seen.front().constraint_violation, 10.0);
  EXPECT_LE(seen.front().constraint_violation, 12.0);
  EXPECT_NEAR(seen.back().cost, result.cost, 1e-6);
  EXPECT_LT(seen.back().dual_violation, 1e-7);
}

struct Slow : Hs071 {
  double cost(const VectorXd& x) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
    return Hs071::cost(x);
  }
};

TEST_P(ProgramSolvers, StopAtTheTimeLimit) {
  Slow nlp;
  SolverOptions options = tight();
  options.max_seconds = 0.12;
  const SolveResult result = solve(nlp, Hs071::guess(), options);
  EXPECT_EQ(result.status, SolveStatus::time_limit) << result.message;
  EXPECT_EQ(result.z.size(), 4);
  EXPECT_LT(result.seconds, 2.0);
}

TEST_P(ProgramSolvers, StopWithinAnIterationOfAnInterrupt) {
  Hs071 nlp;
  std::atomic<bool> interrupt = false;
  int last = -1;
  SolverOptions options = tight();
  options.interrupt = &interrupt;
  options.on_iteration = [&](const SolveProgress& progress) {
    last = progress.iteration;
    if (progress.iteration == 2) interrupt = true;
  };
  const SolveResult result = solve(nlp, Hs071::guess(), options);
  EXPECT_EQ(result.status, SolveStatus::interrupted) << result.message;
  EXPECT_LE(last, 3);
  EXPECT_TRUE(result.z.size() == 4 && result.z.allFinite());
}

/// minimise -slope x: no lower bound unless x has an upper one.
struct Unbounded : test::TestNlp {
  Unbounded() {
    z_lower.setConstant(1, -kInfinity);
    z_upper.setConstant(1, kInfinity);
  }
  double cost(const VectorXd& x) override {
    if (++evaluations == failing_evaluation) throw NumericalError("once");
    return -slope * x[0];
  }
  void cost_gradient(const VectorXd&, Eigen::Ref<VectorXd> gradient) override { gradient[0] = -slope; }
  void constraints(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void jacobian(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void hessian(const VectorXd&, double, const VectorXd&, Eigen::Ref<VectorXd>) override {}
  double slope = 1.0;
  int evaluations = 0, failing_evaluation = 0;
};

TEST_P(ProgramSolvers, DoNotCallAnUnboundedProblemSolved) {
  Unbounded nlp;
  const SolveResult result = solve(nlp, VectorXd::Zero(1));
  EXPECT_EQ(result.status, SolveStatus::solver_failed);
  EXPECT_THAT(result.message, HasSubstr("diverge"));
}

TEST_P(ProgramSolvers, DoNotBlameAnEvaluationThatTheyGotAwayFrom) {
  Unbounded nlp;
  nlp.failing_evaluation = 3;
  const SolveResult result = solve(nlp, VectorXd::Zero(1));
  EXPECT_GT(nlp.evaluations, 3);
  EXPECT_EQ(result.status, SolveStatus::solver_failed);
  EXPECT_THAT(result.message, HasSubstr("diverge"));
}

// So steep that Ipopt, which relaxes bounds a little, ends outside.
TEST_P(ProgramSolvers, StayInsideTheBoundsOfTheVariables) {
  Unbounded nlp;
  nlp.slope = 1e4;
  nlp.z_upper[0] = 2.0;
  const SolveResult result = solve(nlp, VectorXd::Zero(1), SolverOptions());
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_NEAR(result.z[0], 2.0, 1e-6);
  EXPECT_LE(result.z[0], 2.0);
}

TEST_P(ProgramSolvers, RefuseAGuessThatIsNotFinite) {
  Hs071 nlp;
  const SolveResult result = solve(nlp, Eigen::Vector4d(1.0, 5.0, NAN, 1.0));
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("variable 2"));
}

/// NaN, or an exception, from one function: at once, or only where x2 is below a limit.
struct Failing : Hs071 {
  enum class How { nan, numerical_error, logic_error } how = How::nan;
  enum class Where { constraints, gradient, jacobian, hessian } where = Where::constraints;
  double x2_limit = kInfinity;

  bool fails(const VectorXd& x, Where here) const {
    if (here != where || x[2] >= x2_limit) return false;
    if (how == How::numerical_error) throw NumericalError("mass matrix is singular");
    if (how == How::logic_error) throw std::logic_error("index out of range");
    return true;
  }
  void constraints(const VectorXd& x, Eigen::Ref<VectorXd> g) override {
    Hs071::constraints(x, g);
    if (fails(x, Where::constraints)) g[1] = NAN;
  }
  void cost_gradient(const VectorXd& x, Eigen::Ref<VectorXd> gradient) override {
    Hs071::cost_gradient(x, gradient);
    if (fails(x, Where::gradient)) gradient[1] = NAN;
  }
  void jacobian(const VectorXd& x, Eigen::Ref<VectorXd> values) override {
    Hs071::jacobian(x, values);
    if (fails(x, Where::jacobian)) values[4] = INFINITY;
  }
  void hessian(const VectorXd& x, double cost_factor, const VectorXd& multipliers,
               Eigen::Ref<VectorXd> values) override {
    Hs071::hessian(x, cost_factor, multipliers, values);
    if (fails(x, Where::hessian)) values[0] = NAN;
  }
};

TEST_P(ProgramSolvers, SayWhichConstraintIsNan) {
  Failing nlp;
  const SolveResult result = solve(nlp);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("constraint 1"));
}

TEST_P(ProgramSolvers, FindNanInEveryDerivative) {
  for (const auto where : {Failing::Where::gradient, Failing::Where::jacobian, Failing::Where::hessian}) {
    Failing nlp;
    nlp.where = where;
    const SolveResult result = solve(nlp);
    EXPECT_EQ(result.status, SolveStatus::evaluation_failed) << result.message;
    EXPECT_THAT(result.message, HasSubstr("variable"));
  }
}

TEST_P(ProgramSolvers, FindNanThatComesLate) {
  Failing nlp;
  nlp.where = Failing::Where::jacobian;
  nlp.x2_limit = 3.9;  // the optimum has x2 = 3.82
  const SolveResult result = solve(nlp);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed) << result.message;
  EXPECT_GT(result.iterations, 0);
  EXPECT_TRUE(result.z.size() == 4 && result.z.allFinite());
}

/// minimise sqrt(1 + x^2), not to be evaluated at x < -5. From x = 3 the Newton step leads to -x^3 = -27.
struct Overshoot : test::TestNlp {
  Overshoot() {
    z_lower.setConstant(1, -kInfinity);
    z_upper.setConstant(1, kInfinity);
    hessian_entries = {{0}, {0}};
  }
  double cost(const VectorXd& x) override {
    if (x[0] >= -5.0) return std::sqrt(1.0 + x[0] * x[0]);
    ++refused;
    throw NumericalError("too far");
  }
  void cost_gradient(const VectorXd& x, Eigen::Ref<VectorXd> gradient) override { gradient[0] = x[0] / cost(x); }
  void constraints(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void jacobian(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void hessian(const VectorXd& x, double cost_factor, const VectorXd&, Eigen::Ref<VectorXd> values) override {
    values[0] = cost_factor / std::pow(cost(x), 3);
  }
  int refused = 0;
};

TEST_P(ProgramSolvers, ShortenAStepToAPointThatCannotBeEvaluated) {
  Overshoot nlp;
  const SolveResult result = solve(nlp, VectorXd::Constant(1, 3.0));
  EXPECT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_NEAR(result.z[0], 0.0, 1e-6);
  EXPECT_GT(nlp.refused, 0) << "no trial point was refused, so the test checks nothing";
}

TEST_P(ProgramSolvers, ReportANumericalErrorAsAFailedEvaluation) {
  Failing nlp;
  nlp.how = Failing::How::numerical_error;
  const SolveResult result = solve(nlp);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("mass matrix is singular"));
}

TEST_P(ProgramSolvers, StopAtAnyOtherException) {
  for (const double limit : {Hs071::kInfinity, 3.9}) {
    Failing nlp;
    nlp.how = Failing::How::logic_error;
    nlp.x2_limit = limit;
    const SolveResult result = solve(nlp);
    EXPECT_EQ(result.status, SolveStatus::solver_failed);
    EXPECT_THAT(result.message, HasSubstr("index out of range"));
  }
}

TEST_P(ProgramSolvers, NameBoundsThatCannotHold) {
  Hs071 nlp;
  EXPECT_EQ(solver->why_unsupported(nlp), std::nullopt);
  nlp.g_lower[1] = 41.0;
  EXPECT_THAT(solver->why_unsupported(nlp).value_or(""), HasSubstr("constraint 1"));
  nlp = {};
  nlp.z_upper[3] = NAN;
  EXPECT_THAT(solver->why_unsupported(nlp).value_or(""), HasSubstr("variable 3"));
}

TEST_P(ProgramSolvers, RefuseArgumentsThatMakeNoSense) {
  Hs071 nlp;
  SolverOptions options;
  options.tolerance = -1.0;
  EXPECT_THROW(solve(nlp, Hs071::guess(), options), InputError);
  EXPECT_THROW(solve(nlp, VectorXd::Zero(3)), InputError);
}

}  // namespace
}  // namespace prowl

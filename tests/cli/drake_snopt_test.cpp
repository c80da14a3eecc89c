#include "drake_snopt.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "prowl/error.hpp"
#include "tests/nlp/test_problems.hpp"

namespace prowl::cli {
namespace {

using Eigen::Vector4d;
using Eigen::VectorXd;
using test::Hs071;
using ::testing::HasSubstr;

const Vector4d kOptimum(1.0, 4.74299964, 3.82114998, 1.37940829);  // Hock, Schittkowski 1981

SolveResult solve(Nlp& nlp, const SolverOptions& options = {}) {
  return DrakeSnopt(PROWL_PYTHON).solve(nlp, Hs071::start(), options);
}

TEST(DrakeSnopt, FindsTheOptimumAndItsMultipliers) {
  Hs071 nlp;
  std::vector<SolveProgress> seen;
  VectorXd last;
  SolverOptions options;
  options.on_iteration = [&seen](const SolveProgress& progress) { seen.push_back(progress); };
  options.on_iterate = [&last](const VectorXd& z) { last = z; };
  const SolveResult result = solve(nlp, options);
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_THAT(result.message, HasSubstr("INFO 1"));
  EXPECT_LT((result.z - kOptimum).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_NEAR(result.cost, 17.0140172892, 1e-6);
  EXPECT_LT(result.constraint_violation, 1e-6);
  ASSERT_EQ(result.multipliers.size(), 2);
  EXPECT_NEAR(result.multipliers[0], -0.55229366, 1e-4);
  EXPECT_NEAR(result.multipliers[1], 0.16146857, 1e-4);
  EXPECT_LT(result.dual_violation, 1e-4);
  EXPECT_GT(result.iterations, 2);
  EXPECT_GE(std::ssize(seen), result.iterations);
  EXPECT_LT((last - kOptimum).lpNorm<Eigen::Infinity>(), 1e-5);
  EXPECT_GT(result.times.evaluation(), 0.0);
  EXPECT_LT(result.times.evaluation(), result.seconds);
  EXPECT_GT(result.times.cpu, result.times.evaluation()) << "SNOPT's own is of another process";
}

TEST(DrakeSnopt, SaysThatAProblemIsInfeasible) {
  Hs071 nlp;
  nlp.g_lower[1] = nlp.g_upper[1] = 150.0;  // |x|^2 is at most 100
  const SolveResult result = solve(nlp);
  EXPECT_EQ(result.status, SolveStatus::infeasible) << result.message;
  EXPECT_NEAR(result.constraint_violation, 50.0, 1e-3);
}

TEST(DrakeSnopt, StopsAtTheIterationLimitWithItsBestIterate) {
  Hs071 nlp;
  const SolveResult result = solve(nlp, {.max_iterations = 2});
  EXPECT_EQ(result.status, SolveStatus::iteration_limit) << result.message;
  EXPECT_EQ(result.iterations, 2);
  EXPECT_LT(result.constraint_violation, 12.0) << "that of the start";
}

struct NotANumber : Hs071 {
  void constraints(const VectorXd& x, Eigen::Ref<VectorXd> g) override {
    Hs071::constraints(x, g);
    if (++calls == 3) g[1] = NAN;
  }
  int calls = 0;
};

TEST(DrakeSnopt, SaysWhichEvaluationFailed) {
  NotANumber nlp;
  const SolveResult result = solve(nlp);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("constraint is nan at constraint 1"));
  EXPECT_EQ(result.z.size(), 4);
}

struct Slow : Hs071 {
  double cost(const VectorXd& x) override {
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    return Hs071::cost(x);
  }
};

TEST(DrakeSnopt, StopsInTimeWithItsBestIterate) {
  Slow nlp;
  const SolveResult result = solve(nlp, {.max_seconds = 0.5});
  EXPECT_EQ(result.status, SolveStatus::time_limit) << result.message;
  EXPECT_LT(result.seconds, 2.0);
  EXPECT_EQ(result.z.size(), 4);
}

TEST(DrakeSnopt, StopsWhenToldTo) {
  Hs071 nlp;
  std::atomic<bool> interrupt = false;
  SolverOptions options{.interrupt = &interrupt};
  options.on_iteration = [&interrupt](const SolveProgress& progress) { interrupt = progress.iteration == 1; };
  const SolveResult result = solve(nlp, options);
  EXPECT_EQ(result.status, SolveStatus::interrupted) << result.message;
}

TEST(MakeSnopt, SaysWhatIsMissing) {
  try {
    make_snopt("/nowhere/libsnopt7.so", PROWL_PYTHON);
    ADD_FAILURE() << "a library that is named and is not there";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("--snopt-library: SNOPT is commercial"));
  }
  EXPECT_EQ(make_snopt(PROWL_SNOPT_DOUBLE, PROWL_PYTHON)->version(), "7");

  Hs071 nlp;
  EXPECT_THROW(make_snopt(std::nullopt, "/nowhere/python")->solve(nlp, Hs071::start(), {}), InputError);
  try {
    DrakeSnopt(PROWL_BARE_PYTHON).solve(nlp, Hs071::start(), {});
    ADD_FAILURE() << "a Python without packages";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("pip install drake==1.51.1"));
  }
}

}  // namespace
}  // namespace prowl::cli

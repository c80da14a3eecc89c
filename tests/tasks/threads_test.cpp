// How many threads evaluate a problem changes nothing of what comes out, to the last bit.
#include <gtest/gtest.h>

#include <limits>
#include <vector>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

Task step_task() {
  return read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/step.toml", test::test_search(), {.intervals = 24});
}

void expect_same_with_more_threads(const NlpSolver& solver) {
  const Task task = step_task();
  SolverOptions options = task.solver;
  const SolveResult one = make_plan({task.problem, task.mesh}, solver, {.solver = options}).result;
  ASSERT_EQ(one.status, SolveStatus::converged) << one.message;
  for (const int threads : {2, 3}) {
    options.threads = threads;
    const SolveResult more = make_plan({task.problem, task.mesh}, solver, {.solver = options}).result;
    EXPECT_EQ(more.status, one.status) << more.message;
    EXPECT_EQ(more.iterations, one.iterations);
    EXPECT_EQ(more.cost, one.cost);
    EXPECT_EQ(more.z, one.z) << threads << " threads";
    EXPECT_EQ(more.dual_violation, one.dual_violation);
    for (std::size_t k = 0; k < one.stage_multipliers.size(); ++k) {
      EXPECT_EQ(more.stage_multipliers[k].next, one.stage_multipliers[k].next);
      EXPECT_EQ(more.stage_multipliers[k].inequalities, one.stage_multipliers[k].inequalities);
    }
  }
}

TEST(Threads, RiccatiFindsTheSame) { expect_same_with_more_threads(RiccatiSolver()); }

TEST(Threads, IpoptFindsTheSame) { expect_same_with_more_threads(IpoptSolver()); }

TEST(Threads, WhatFailsIsTheSame) {
  const Task task = step_task();
  const DiscreteProblem discrete(task.problem, task.mesh);
  const Trajectory guess = initial_guess(discrete);
  const auto failure = [&](int threads, std::vector<double> fractions) {
    Transcription nlp(discrete, guess);
    Eigen::VectorXd z_guess = nlp.pack(guess);
    for (const double fraction : fractions) {
      z_guess(static_cast<Eigen::Index>(fraction * static_cast<double>(z_guess.size()))) =
          std::numeric_limits<double>::quiet_NaN();
    }
    SolverOptions options = task.solver;
    options.threads = threads;
    const SolveResult result = RiccatiSolver().solve(nlp, z_guess, options);
    EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
    return result.message;
  };
  const std::string one = failure(1, {0.3, 0.8});
  EXPECT_EQ(one, failure(1, {0.3}));
  EXPECT_NE(one, failure(1, {0.8})) << "the message does not say where";
  for (const int threads : {2, 3}) EXPECT_EQ(failure(threads, {0.3, 0.8}), one) << threads << " threads";
}

}  // namespace
}  // namespace prowl

// How many threads evaluate a problem changes nothing of what comes out, to the last bit.
#include <gtest/gtest.h>

#include "../io/test_files.hpp"
#include "prowl/io/task_file.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/ipopt_solver.hpp"
#include "prowl/solvers/riccati_solver.hpp"

namespace prowl {
namespace {

Task step_task() {
  return read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/step.toml", test::test_search(), {.intervals = 24});
}

void expect_same_with_more_threads(const NlpSolver& solver) {
  const Task task = step_task();
  SolverOptions options = task.solver;
  const SolveResult one = make_plan(task.problem, solver, {.solver = options}).result;
  ASSERT_EQ(one.status, SolveStatus::converged) << one.message;
  for (const int threads : {2, 3}) {
    options.threads = threads;
    const SolveResult more = make_plan(task.problem, solver, {.solver = options}).result;
    EXPECT_EQ(more.status, one.status) << more.message;
    EXPECT_EQ(more.iterations, one.iterations);
    EXPECT_EQ(more.cost, one.cost);
    EXPECT_EQ(more.z, one.z) << threads << " threads";
  }
}

TEST(Threads, RiccatiFindsTheSame) { expect_same_with_more_threads(RiccatiSolver()); }

TEST(Threads, IpoptFindsTheSame) { expect_same_with_more_threads(IpoptSolver()); }

TEST(Threads, WhatFailsIsTheSame) {
  Task task = step_task();
  BoundaryCondition& start = task.problem.boundary_conditions.front();
  start.velocity_lower(0) = start.velocity_upper(0) = 1e200;  // squared it is not finite
  std::string message;
  for (const int threads : {1, 2}) {
    SolverOptions options = task.solver;
    options.threads = threads;
    try {
      const SolveResult result = make_plan(task.problem, RiccatiSolver(), {.solver = options}).result;
      EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
      if (threads == 1) message = result.message;
      EXPECT_EQ(result.message, message);
    } catch (const std::exception& error) {
      if (threads == 1) message = error.what();
      EXPECT_EQ(error.what(), message);
    }
  }
  EXPECT_FALSE(message.empty());
}

}  // namespace
}  // namespace prowl

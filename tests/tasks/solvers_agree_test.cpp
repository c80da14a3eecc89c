// All solvers find the same motion of the shipped tasks of HyQ, on few intervals.
#include <gtest/gtest.h>

#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/task_file/task_file.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

class SolversAgree : public ::testing::TestWithParam<const char*> {};

void expect_same_motion(const Plan& plan, const Plan& ipopt) {
  SCOPED_TRACE(plan.solver);
  ASSERT_EQ(plan.result.status, SolveStatus::converged) << plan.result.message;
  // Ipopt relaxes bounds.
  EXPECT_NEAR(plan.result.cost, ipopt.result.cost, 3e-6 * std::max(1e-3, ipopt.result.cost));
  for (std::size_t k = 0; k < ipopt.trajectory.nodes.size(); ++k) {
    const TrajectoryPoint &a = ipopt.trajectory.nodes[k], &b = plan.trajectory.nodes[k];
    EXPECT_NEAR(a.time, b.time, 1e-4);
    EXPECT_LT((a.q - b.q).cwiseAbs().maxCoeff(), 1e-4) << "t = " << a.time << " s";
  }
}

void expect_agreement(const std::string& name, int intervals, const std::vector<std::string>& solvers) {
  const std::string file = std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + name + ".toml";
  Task task = read_task_file(file, test::test_search(), {.intervals = intervals});
  task.solver.tolerance = 1e-8;
  const Plan ipopt = make_plan({task.problem, task.mesh}, IpoptSolver(), {.solver = task.solver});
  ASSERT_EQ(ipopt.result.status, SolveStatus::converged) << ipopt.result.message;
  for (const std::string& solver : solvers)
    expect_same_motion(make_plan({task.problem, task.mesh}, *make_solver(solver), {.solver = task.solver}), ipopt);
}

TEST_P(SolversAgree, OnTheMotion) { expect_agreement(GetParam(), 24, {"fatrop", "riccati", "ipopt-spral"}); }

/// Its quadratic programs are dense in what is free: with 24 intervals they take minutes. So does step with 13, since
/// held feet carry a least load; rear and kneel have phases, too.
TEST(UnoAgrees, OnFewerIntervals) {
  expect_agreement("stand", 6, {"uno"});
  expect_agreement("crouch", 6, {"uno"});
  expect_agreement("rear", 8, {"uno"});
  expect_agreement("kneel", 8, {"uno"});
}

/// Iterates that differ in the last digit part ways where the Hessian is indefinite: step, with 24 intervals.
TEST(Spral, DoesTheSameTwice) {
  const Task task =
      read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/step.toml", test::test_search(), {.intervals = 24});
  const std::unique_ptr<NlpSolver> solver = make_solver("ipopt-spral");
  const Plan first = make_plan({task.problem, task.mesh}, *solver, {.solver = task.solver});
  const Plan second = make_plan({task.problem, task.mesh}, *solver, {.solver = task.solver});
  ASSERT_EQ(first.result.status, SolveStatus::converged) << first.result.message;
  EXPECT_EQ(first.result.iterations, second.result.iterations);
  EXPECT_EQ(first.result.z, second.result.z);
}

/// Newton's method and Gauss and Newton's have one solution; the latter takes longer to it.
TEST(GaussNewton, FindsTheSameMotion) {
  const Task task =
      read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/crouch.toml", test::test_search(), {.intervals = 24});
  const Plan exact = make_plan({task.problem, task.mesh}, RiccatiSolver(), {.solver = task.solver});
  const Plan other = make_plan({task.problem, task.mesh}, RiccatiSolver(),
                               {.solver = task.solver, .hessian = HessianKind::gauss_newton});
  ASSERT_EQ(other.result.status, SolveStatus::converged) << other.result.message;
  EXPECT_NEAR(other.result.cost, exact.result.cost, 1e-6 * exact.result.cost);
  EXPECT_GT(other.result.iterations, exact.result.iterations);
}

INSTANTIATE_TEST_SUITE_P(All, SolversAgree, ::testing::Values("hold", "stand", "crouch", "balance", "step"),
                         [](const auto& task) { return std::string(task.param); });

}  // namespace
}  // namespace prowl

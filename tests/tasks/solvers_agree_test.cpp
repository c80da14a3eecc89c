// Fatrop, Riccati and Ipopt find the same motion of the shipped tasks of HyQ, on few intervals.
#include <gtest/gtest.h>

#include "../io/test_files.hpp"
#include "prowl/io/task_file.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/fatrop_solver.hpp"
#include "prowl/solvers/ipopt_solver.hpp"
#include "prowl/solvers/riccati_solver.hpp"

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

TEST_P(SolversAgree, OnTheMotion) {
  const std::string file = std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/" + GetParam() + ".toml";
  Task task = read_task_file(file, test::test_search(), {.intervals = 24});
  task.solver.tolerance = 1e-8;
  const Plan ipopt = make_plan(task.problem, IpoptSolver(), {.solver = task.solver});
  ASSERT_EQ(ipopt.result.status, SolveStatus::converged) << ipopt.result.message;
  const Plan fatrop = make_plan(task.problem, FatropSolver(), {.solver = task.solver});
  EXPECT_EQ(fatrop.solver, "Fatrop");
  expect_same_motion(fatrop, ipopt);
  const Plan riccati = make_plan(task.problem, RiccatiSolver(), {.solver = task.solver});
  EXPECT_EQ(riccati.solver, "Riccati");
  expect_same_motion(riccati, ipopt);
}

/// Newton's method and Gauss and Newton's have one solution; the latter takes longer to it.
TEST(GaussNewton, FindsTheSameMotion) {
  const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/hyq/crouch.toml", test::test_search(), {.intervals = 24});
  const Plan exact = make_plan(task.problem, RiccatiSolver(), {.solver = task.solver});
  const Plan other = make_plan(task.problem, RiccatiSolver(), {.solver = task.solver, .hessian = HessianKind::gauss_newton});
  ASSERT_EQ(other.result.status, SolveStatus::converged) << other.result.message;
  EXPECT_NEAR(other.result.cost, exact.result.cost, 1e-6 * exact.result.cost);
  EXPECT_GT(other.result.iterations, exact.result.iterations);
}

INSTANTIATE_TEST_SUITE_P(All, SolversAgree, ::testing::Values("hold", "stand", "crouch", "balance", "step"),
                         [](const auto& task) { return std::string(task.param); });

}  // namespace
}  // namespace prowl

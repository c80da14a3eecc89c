// What Uno does that the others do not; what all do is in program_solvers_test.
#include "prowl/solvers/foreign/uno_solver.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <vector>

#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using test::Hs071;

/// First in this file: Uno warns of fixed variables before it has read that it is not to, once in a process.
TEST(UnoSolver, PrintsNothingTheFirstTime) {
  Hs071 nlp;
  nlp.z_lower[2] = nlp.z_upper[2] = 3.0;
  testing::internal::CaptureStdout();
  const SolveResult result = UnoSolver().solve(nlp, Hs071::guess(), {});
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
  EXPECT_EQ(result.status, SolveStatus::converged) << result.message;
}

/// minimise x0^2 + x0 x1 + 2 x1^2 - 3 x1  subject to  x0 + x1 = 1: a quadratic program. Lagrangian stationary at
/// 2 x0 + x1 + y = 0, x0 + 4 x1 - 3 + y = 0: x = (0, 1), y = -1.
struct Quadratic : test::TestNlp {
  Quadratic() {
    z_lower.setConstant(2, -kInfinity);
    z_upper.setConstant(2, kInfinity);
    g_lower = g_upper = VectorXd::Ones(1);
    jacobian_entries = {{0, 0}, {0, 1}};
    hessian_entries = {{0, 1, 1}, {0, 0, 1}};
  }
  double cost(const VectorXd& x) override { return x[0] * x[0] + x[0] * x[1] + 2.0 * x[1] * x[1] - 3.0 * x[1]; }
  void cost_gradient(const VectorXd& x, Eigen::Ref<VectorXd> gradient) override {
    gradient << 2.0 * x[0] + x[1], x[0] + 4.0 * x[1] - 3.0;
  }
  void constraints(const VectorXd& x, Eigen::Ref<VectorXd> g) override { g[0] = x.sum(); }
  void jacobian(const VectorXd&, Eigen::Ref<VectorXd> values) override { values.setOnes(); }
  void hessian(const VectorXd&, double cost_factor, const VectorXd&, Eigen::Ref<VectorXd> values) override {
    ++hessians;
    values << 2.0, 1.0, 4.0;
    values *= cost_factor;
  }
  int hessians = 0;
};

/// It does so only if the products with the Hessian, both triangles of it, are right.
TEST(UnoSolver, SolvesAQuadraticProgramInOneStep) {
  Quadratic nlp;
  const SolveResult result = UnoSolver().solve(nlp, Eigen::Vector2d(3.0, -2.0), {.tolerance = 1e-10});
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_EQ(result.iterations, 1);
  EXPECT_LT((result.z - Eigen::Vector2d(0.0, 1.0)).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_NEAR(result.multipliers[0], -1.0, 1e-10);
  EXPECT_EQ(nlp.hessians, 1) << "once for all products";
}

/// The Hessian of the constraints too: without it, or with its sign turned, the last steps are not Newton's.
TEST(UnoSolver, ConvergesQuadratically) {
  Hs071 nlp;
  std::vector<double> violations;
  SolverOptions options{.tolerance = 1e-12};
  options.on_iteration = [&](const SolveProgress& progress) { violations.push_back(progress.constraint_violation); };
  const SolveResult result = UnoSolver().solve(nlp, Hs071::guess(), options);
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  ASSERT_GE(violations.size(), 4u);
  const auto last = violations.rbegin();
  EXPECT_LT(last[0], 1e-12);
  EXPECT_LT(last[1], 10.0 * last[2] * last[2]);
}

/// Interrupted from within the Hessian, which is asked for in the midst of a quadratic program.
struct Interrupting : Hs071 {
  void hessian(const VectorXd& x, double cost_factor, const VectorXd& multipliers,
               Eigen::Ref<VectorXd> values) override {
    Hs071::hessian(x, cost_factor, multipliers, values);
    interrupt = ++hessians == 3;
  }
  std::atomic<bool> interrupt = false;
  int hessians = 0;
};

TEST(UnoSolver, StopsInTheMidstOfAQuadraticProgram) {
  Interrupting nlp;
  const SolveResult result = UnoSolver().solve(nlp, Hs071::guess(), {.interrupt = &nlp.interrupt});
  EXPECT_EQ(result.status, SolveStatus::interrupted) << result.message;
  EXPECT_EQ(nlp.hessians, 3);
  EXPECT_EQ(result.iterations, 2);
  Hs071 other;
  EXPECT_EQ(UnoSolver().solve(other, Hs071::guess(), {}).status, SolveStatus::converged) << "the next solve suffers";
}

}  // namespace
}  // namespace prowl

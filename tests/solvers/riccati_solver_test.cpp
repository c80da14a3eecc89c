// What this solver does beyond the laws of tests/solvers/chain_solvers_test.cpp.
#include "prowl/solvers/riccati/riccati_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "tests/solvers/cart.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector2d;
using Eigen::VectorXd;
using test::Cart;

TEST(RiccatiSolver, CallsWhatCannotBeInfeasible) {
  for (const double goal : {3.0, 10.0, -10.0}) {
    Cart cart({.goal = goal});
    const SolveResult result = RiccatiSolver().solve(cart, Cart::zeros(), {.max_iterations = 1000});
    EXPECT_EQ(result.status, SolveStatus::infeasible) << result.message;
    EXPECT_LT(result.iterations, 1000);
    EXPECT_GT(result.constraint_violation, 0.1);
  }
}

TEST(RiccatiSolver, NeedsNoBounds) {
  Cart cart({.least = -INFINITY, .most = INFINITY});
  const SolveResult result = RiccatiSolver().solve(cart, Cart::zeros(), {});
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_NEAR(result.cost, IpoptSolver().solve(cart, Cart::zeros(), {}).cost, 1e-6);
}

/// One stage of states alone, without inequalities. Also an Nlp.
class OneStage : public test::TestNlp, public test::DenseStagewiseNlp {
 public:
  OneStage(int states, int equalities) : size_{0, states, equalities, 0} {
    z_lower.setConstant(states, -kInfinity);
    z_upper.setConstant(states, kInfinity);
  }
  StagewiseNlp* stagewise() override { return this; }
  void cost_gradient(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void constraints(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void jacobian(const VectorXd&, Eigen::Ref<VectorXd>) override {}
  void hessian(const VectorXd&, double, const VectorXd&, Eigen::Ref<VectorXd>) override {}

  int num_stages() const override { return 1; }
  const StageSize& size(int) const override { return size_; }
  const VectorXd& lower(int) const override { return none_; }
  const VectorXd& upper(int) const override { return none_; }
  const StageValues& values(int, const VectorXd& z) override {
    values_.cost = cost(z);
    return values_;
  }
  std::vector<VectorXd> stages(const VectorXd& z) const override { return {z}; }
  VectorXd flat(const std::vector<VectorXd>& stages) const override { return stages[0]; }
  std::string describe_stage(int) const override { return "the stage"; }

 protected:
  StageSize size_;
  VectorXd none_;
  StageValues values_;
  StageDerivatives derivatives_;
  MatrixXd hessian_;
};

/// Two states and an equality:  minimise cost(x)  subject to  |x|^2 = 1.
class OnACircle : public OneStage {
 public:
  OnACircle() : OneStage(2, 1) { g_lower = g_upper = VectorXd::Ones(1); }
  void constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) override { g << z.squaredNorm(); }

  /// Powell 1986 (the Maratos effect): full steps towards (1, 0) raise both the cost and the violation.
  double cost(const VectorXd& z) override { return 2.0 * (z.squaredNorm() - 1.0) - z(0); }

  const StageValues& values(int k, const VectorXd& z) override {
    values_.equalities = VectorXd::Constant(1, z.squaredNorm() - 1.0);
    return OneStage::values(k, z);
  }
  const StageDerivatives& derivatives(int, const VectorXd& z) override {
    derivatives_ = {4.0 * z - VectorXd(Vector2d(1.0, 0.0)), MatrixXd(0, 2), 2.0 * z.transpose(), MatrixXd(0, 2)};
    return derivatives_;
  }
  using OneStage::hessian;
  const MatrixXd& hessian(int, const VectorXd&, double cost_factor, const StageMultipliers& on) override {
    hessian_ = (4.0 * cost_factor + 2.0 * on.equalities(0)) * MatrixXd::Identity(2, 2);
    return hessian_;
  }
};

/// Whole steps, by second order corrections, are as fast as Newton's method; half steps are not.
TEST(RiccatiSolver, TakesWholeStepsAlongCurvedConstraints) {
  for (const double angle : {0.1, 0.3, 0.5}) {
    OnACircle nlp;
    const Vector2d guess(std::cos(angle), std::sin(angle));
    const SolveResult result = RiccatiSolver().solve(nlp, guess, {.tolerance = 1e-9});
    ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
    EXPECT_LT((result.z - VectorXd(Vector2d(1.0, 0.0))).norm(), 1e-8);
    EXPECT_LE(result.iterations, 5) << angle;
  }
}

/// Opposite the minimum the reduced Hessian is negative: a maximum, where Newton's method goes if nothing regularises
/// it.
TEST(RiccatiSolver, GoesAwayFromMaxima) {
  OnACircle nlp;
  const SolveResult result = RiccatiSolver().solve(nlp, Vector2d(-0.999, 0.04), {});
  ASSERT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_LT((result.z - VectorXd(Vector2d(1.0, 0.0))).norm(), 1e-5);
}

/// One state without a condition on it; its cost falls for ever, and hardly.
class OnASlope : public OneStage {
 public:
  explicit OnASlope(double slope) : OneStage(1, 0), slope_(slope) { hessian_ = MatrixXd::Zero(1, 1); }
  double cost(const VectorXd& z) override { return -slope_ * z(0); }
  void cost_gradient(const VectorXd&, Eigen::Ref<VectorXd> gradient) override { gradient << -slope_; }
  const StageDerivatives& derivatives(int, const VectorXd&) override {
    derivatives_ = {VectorXd::Constant(1, -slope_), MatrixXd(0, 1), MatrixXd(0, 1), MatrixXd(0, 1)};
    return derivatives_;
  }
  using OneStage::hessian;
  const MatrixXd& hessian(int, const VectorXd&, double, const StageMultipliers&) override { return hessian_; }

 private:
  double slope_;
};

/// It would take hundreds of iterations for digits that nobody needs.
TEST(RiccatiSolver, EndsAmongIteratesThatAreAsGoodAsOptimal) {
  OnASlope gentle(1e-5), steep(1e-3);
  const SolverOptions options{.tolerance = 1e-6, .max_iterations = 50};
  const SolveResult near = RiccatiSolver().solve(gentle, VectorXd::Zero(1), options);
  EXPECT_EQ(near.status, SolveStatus::converged) << near.message;
  EXPECT_NE(near.message.find("100 times the tolerance"), std::string::npos) << near.message;
  EXPECT_LT(near.iterations, 20);
  EXPECT_EQ(RiccatiSolver().solve(steep, VectorXd::Zero(1), options).status, SolveStatus::iteration_limit);
}

}  // namespace
}  // namespace prowl

#include "prowl/solvers/fatrop_solver.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "prowl/error.hpp"
#include "prowl/solvers/ipopt_solver.hpp"
#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using ::testing::HasSubstr;

/// A point mass with drag goes from rest at 0 to rest at 1 in N steps of h, its force at most kForce:
///   p' = p + h v,  v' = v + h (f - v^3),   minimise sum of h f^2 / 2.
/// z = (f0, p1, v1, f1, p2, v2, ... pN, vN): stage k has u = f_k and x = (p_k, v_k), the first no state, the last no input.
class Cart : public test::TestNlp, public DenseStagewiseNlp {
 public:
  static constexpr int kSteps = 20;
  static constexpr double h = 0.1, kForce = 1.4;

  Cart() {
    z_lower.setConstant(3 * kSteps, -kInfinity);
    z_upper.setConstant(3 * kSteps, kInfinity);
    for (int k = 0; k < kSteps; ++k) {
      z_lower(3 * k) = -kForce;
      z_upper(3 * k) = kForce;
    }
    z_lower.tail<2>() = z_upper.tail<2>() = Eigen::Vector2d(1.0, 0.0);
    g_lower = g_upper = VectorXd::Zero(2 * kSteps);
    for (int k = 0; k < kSteps; ++k) {
      for (int row : {0, 1}) {
        for (int col = state(k); col < state(k + 1) + 2; ++col) {
          if (col >= 0) add(jacobian_places, 2 * k + row, col);
        }
      }
    }
    for (int i = 0; i < 3 * kSteps; ++i) add(hessian_places, i, i);
    for (int k = 0; k <= kSteps; ++k) {
      StageSize& size = sizes_[k];
      size = {k < kSteps ? 1 : 0, k > 0 ? 2 : 0, k == kSteps ? 2 : 0, k < kSteps ? 1 : 0};
      lower_[k].setConstant(size.inequalities, -kForce);
      upper_[k].setConstant(size.inequalities, kForce);
    }
  }

  /// Where the cost is NaN, if anywhere: |f| below this.
  double nan_below = -1.0;
  /// The derivatives are NaN from the n-th evaluation on.
  int nan_after = 1 << 30;

  StagewiseNlp* stagewise() override { return this; }

  double cost(const VectorXd& z) override {
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) sum += cost_of(z(3 * k));
    return sum;
  }
  void cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) override {
    gradient.setZero();
    for (int k = 0; k < kSteps; ++k) gradient(3 * k) = h * z(3 * k);
  }
  void constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) override {
    for (int k = 0; k < kSteps; ++k) {
      const auto [p, v] = at(z, k);
      g.segment<2>(2 * k) = next(z(3 * k), p, v) - z.segment<2>(state(k + 1));
    }
  }
  void jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) override {
    int i = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double v = at(z, k).second;
      const double rows[2][5] = {{1.0, h, 0.0, -1.0, 0.0}, {0.0, 1.0 - 3.0 * h * v * v, h, 0.0, -1.0}};
      for (const auto& row : rows) {
        for (int col = k == 0 ? 2 : 0; col < 5; ++col) values(i++) = row[col];
      }
    }
  }
  void hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
               Eigen::Ref<VectorXd> values) override {
    values.setZero();
    for (int k = 0; k < kSteps; ++k) values(3 * k) = cost_factor * h;
    for (int k = 1; k < kSteps; ++k) values(state(k) + 1) = -6.0 * h * multipliers(2 * k + 1) * at(z, k).second;
  }

  int num_stages() const override { return kSteps + 1; }
  const StageSize& size(int k) const override { return sizes_[k]; }
  const VectorXd& lower(int k) const override { return lower_[k]; }
  const VectorXd& upper(int k) const override { return upper_[k]; }
  const StageValues& values(int k, const VectorXd& ux) override {
    const auto [f, p, v] = unpack(k, ux);
    values_.cost = k < kSteps ? cost_of(f) : 0.0;
    values_.next = k < kSteps ? VectorXd(next(f, p, v)) : VectorXd();
    values_.equalities = k < kSteps ? VectorXd() : VectorXd(Eigen::Vector2d(p - 1.0, v));
    values_.inequalities = VectorXd::Constant(sizes_[k].inequalities, f);
    return values_;
  }
  const StageDerivatives& derivatives(int k, const VectorXd& ux) override {
    const auto [f, p, v] = unpack(k, ux);
    const Eigen::Index n = ux.size();
    derivatives_.cost_gradient.setZero(n);
    derivatives_.next.setZero(k < kSteps ? 2 : 0, n);
    derivatives_.equalities = MatrixXd::Identity(sizes_[k].equalities, n);
    derivatives_.inequalities = MatrixXd::Identity(sizes_[k].inequalities, n);
    if (k == kSteps) return derivatives_;
    derivatives_.cost_gradient(0) = ++evaluations_ > nan_after ? NAN : h * f;
    derivatives_.next(1, 0) = h;
    if (k > 0) derivatives_.next.rightCols<2>() << 1.0, h, 0.0, 1.0 - 3.0 * h * v * v;
    return derivatives_;
  }
  const MatrixXd& hessian(int k, const VectorXd& ux, double cost_factor, const StageMultipliers& on) override {
    hessian_.setZero(ux.size(), ux.size());
    if (k == kSteps) return hessian_;
    hessian_(0, 0) = cost_factor * h;
    if (k > 0) hessian_(2, 2) = -6.0 * h * on.next(1) * ux(2);
    return hessian_;
  }
  std::vector<VectorXd> stages(const VectorXd& z) const override {
    std::vector<VectorXd> result = {z.head<1>()};
    for (int k = 1; k <= kSteps; ++k) {
      VectorXd ux(sizes_[k].variables());
      if (k < kSteps) ux(0) = z(3 * k);
      ux.tail<2>() = z.segment<2>(state(k));
      result.push_back(ux);
    }
    return result;
  }
  VectorXd flat(const std::vector<VectorXd>& stages) const override {
    VectorXd z(3 * kSteps);
    for (int k = 0; k <= kSteps; ++k) {
      if (k < kSteps) z(3 * k) = stages[static_cast<std::size_t>(k)](0);
      if (k > 0) z.segment<2>(state(k)) = stages[static_cast<std::size_t>(k)].tail<2>();
    }
    return z;
  }
  std::string describe_stage(int k) const override { return "stage " + std::to_string(k); }

 private:
  static void add(SparsityPattern& pattern, int row, int col) {
    pattern.rows.push_back(row);
    pattern.cols.push_back(col);
  }
  static int state(int k) { return 3 * k - 2; }  ///< of p_k in z
  static std::pair<double, double> at(const VectorXd& z, int k) {
    return k == 0 ? std::pair(0.0, 0.0) : std::pair(z(state(k)), z(state(k) + 1));
  }
  static Eigen::Vector2d next(double f, double p, double v) { return {p + h * v, v + h * (f - v * v * v)}; }
  double cost_of(double f) const { return std::abs(f) < nan_below ? NAN : 0.5 * h * f * f; }
  std::tuple<double, double, double> unpack(int k, const VectorXd& ux) const {
    const bool has_state = k > 0;
    return {k < kSteps ? ux(0) : 0.0, has_state ? ux(ux.size() - 2) : 0.0, has_state ? ux(ux.size() - 1) : 0.0};
  }

  StageSize sizes_[kSteps + 1];
  VectorXd lower_[kSteps + 1], upper_[kSteps + 1];
  StageValues values_;
  StageDerivatives derivatives_;
  MatrixXd hessian_;
  int evaluations_ = 0;
};

VectorXd zeros() { return VectorXd::Zero(3 * Cart::kSteps); }

TEST(FatropSolver, FindsWhatIpoptFinds) {
  Cart cart;
  const SolverOptions options{.tolerance = 1e-9};
  const SolveResult fatrop = FatropSolver().solve(cart, zeros(), options);
  const SolveResult ipopt = IpoptSolver().solve(cart, zeros(), options);
  ASSERT_EQ(fatrop.status, SolveStatus::converged) << fatrop.message;
  ASSERT_EQ(ipopt.status, SolveStatus::converged) << ipopt.message;
  EXPECT_LT((fatrop.z - ipopt.z).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(fatrop.cost, ipopt.cost, 1e-8);
  EXPECT_LT(fatrop.constraint_violation, 1e-9);
  EXPECT_NEAR(fatrop.z(0), Cart::kForce, 1e-4) << "no limit is active, so that nothing tests them";
}

TEST(FatropSolver, TellsEveryIteration) {
  Cart cart;
  int calls = 0;
  SolverOptions options;
  options.on_iteration = [&](const SolveProgress& progress) { EXPECT_EQ(progress.iteration, calls++); };
  const SolveResult result = FatropSolver().solve(cart, zeros(), options);
  EXPECT_EQ(result.status, SolveStatus::converged);
  EXPECT_EQ(calls, result.iterations);
}

TEST(FatropSolver, StopsAtTheLimitOfIterations) {
  for (const int limit : {0, 1, 3}) {
    Cart cart;
    const SolveResult result = FatropSolver().solve(cart, zeros(), {.max_iterations = limit});
    EXPECT_EQ(result.status, SolveStatus::iteration_limit);
    EXPECT_EQ(result.iterations, limit);
  }
}

TEST(FatropSolver, StopsWhenTheTimeIsUp) {
  Cart cart;
  EXPECT_EQ(FatropSolver().solve(cart, zeros(), {.max_seconds = 1e-9}).status, SolveStatus::time_limit);
}

TEST(FatropSolver, StopsOnRequest) {
  Cart cart;
  std::atomic<bool> stop = false;
  SolverOptions options{.interrupt = &stop};
  options.on_iteration = [&](const SolveProgress& progress) { stop = progress.iteration == 2; };
  const SolveResult result = FatropSolver().solve(cart, zeros(), options);
  EXPECT_EQ(result.status, SolveStatus::interrupted);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_EQ(result.z.size(), cart.num_variables());
}

TEST(FatropSolver, EndsWhereValuesAreNaN) {
  Cart cart;
  cart.nan_below = 0.1;  // the start
  const SolveResult result = FatropSolver().solve(cart, zeros(), {});
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("cost is not finite at stage 0"));
}

TEST(FatropSolver, EndsWhereDerivativesAreNaN) {
  Cart cart;
  cart.nan_after = 3 * Cart::kSteps + 4;
  const SolveResult result = FatropSolver().solve(cart, zeros(), {});
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, HasSubstr("not finite at stage"));
}

TEST(FatropSolver, TakesChainsOnly) {
  test::Hs071 nlp;
  EXPECT_THAT(FatropSolver().why_unsupported(nlp).value_or(""), HasSubstr("chain of stages"));
  EXPECT_EQ(FatropSolver().solve(nlp, test::Hs071::start(), {}).status, SolveStatus::solver_failed);
  Cart cart;
  EXPECT_EQ(FatropSolver().why_unsupported(cart), std::nullopt);
}

TEST(FatropSolver, RefusesAStartOfTheWrongSize) {
  Cart cart;
  EXPECT_THROW(FatropSolver().solve(cart, VectorXd::Zero(3), {}), InputError);
}

}  // namespace
}  // namespace prowl

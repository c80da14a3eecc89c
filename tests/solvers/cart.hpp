#pragma once

#include <Eigen/Core>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "tests/nlp/test_problems.hpp"
#include "tests/support/dense_stagewise_nlp.hpp"

namespace prowl::test {

struct CartTask {
  double goal = 1.0;
  double least = -1.4, most = 1.4;  ///< force
  double curvature = 1.0;           ///< of the cost
};

/// A point mass with drag goes from rest at 0 to rest at the goal in N steps of h, its force bounded:
///   p' = p + h v,  v' = v + h (f - v^3),   minimise sum of h curvature f^2 / 2.
/// z = (f0, p1, v1, f1, p2, v2, ... pN, vN): stage k has u = f_k and x = (p_k, v_k), the first no state, the last no
/// input.
class Cart : public TestNlp, public DenseStagewiseNlp {
 public:
  static constexpr int kSteps = 20;
  static constexpr double h = 0.1;

  explicit Cart(const CartTask& task = {}) : task_(task) {
    z_lower.setConstant(3 * kSteps, -kInfinity);
    z_upper.setConstant(3 * kSteps, kInfinity);
    for (int k = 0; k < kSteps; ++k) {
      z_lower(3 * k) = task.least;
      z_upper(3 * k) = task.most;
    }
    z_lower.tail<2>() = z_upper.tail<2>() = Eigen::Vector2d(task.goal, 0.0);
    g_lower = g_upper = Eigen::VectorXd::Zero(2 * kSteps);
    for (int k = 0; k < kSteps; ++k) {
      for (int row : {0, 1}) {
        for (int col = state(k); col < state(k + 1) + 2; ++col) {
          if (col >= 0) add(jacobian_entries, 2 * k + row, col);
        }
      }
    }
    for (int i = 0; i < 3 * kSteps; ++i) add(hessian_entries, i, i);
    for (int k = 0; k <= kSteps; ++k) {
      StageSize& size = sizes_[k];
      size = {k < kSteps ? 1 : 0, k > 0 ? 2 : 0, k == kSteps ? 2 : 0, k < kSteps ? 1 : 0};
      lower_[k].setConstant(size.inequalities, task.least);
      upper_[k].setConstant(size.inequalities, task.most);
    }
  }

  static Eigen::VectorXd zeros() { return Eigen::VectorXd::Zero(3 * kSteps); }

  /// Where the cost is NaN, if anywhere: |f| below this.
  double nan_below = -1.0;
  /// These derivatives are NaN from the n-th evaluation on.
  enum class Derivative { of_cost, of_next, of_inequalities, second };
  Derivative nan_in = Derivative::of_cost;
  int nan_after = 1 << 30;

  StagewiseNlp* stagewise() override { return this; }

  double cost(const Eigen::VectorXd& z) override {
    double sum = 0.0;
    for (int k = 0; k < kSteps; ++k) sum += cost_of(z(3 * k));
    return sum;
  }
  void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) override {
    gradient.setZero();
    for (int k = 0; k < kSteps; ++k) gradient(3 * k) = h * task_.curvature * z(3 * k);
  }
  void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) override {
    for (int k = 0; k < kSteps; ++k) {
      const auto [p, v] = at(z, k);
      g.segment<2>(2 * k) = next(z(3 * k), p, v) - z.segment<2>(state(k + 1));
    }
  }
  void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) override {
    int i = 0;
    for (int k = 0; k < kSteps; ++k) {
      const double v = at(z, k).second;
      const double rows[2][5] = {{1.0, h, 0.0, -1.0, 0.0}, {0.0, 1.0 - 3.0 * h * v * v, h, 0.0, -1.0}};
      for (const auto& row : rows) {
        for (int col = k == 0 ? 2 : 0; col < 5; ++col) values(i++) = row[col];
      }
    }
  }
  void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    values.setZero();
    for (int k = 0; k < kSteps; ++k) values(3 * k) = cost_factor * h * task_.curvature;
    for (int k = 1; k < kSteps; ++k) values(state(k) + 1) = -6.0 * h * multipliers(2 * k + 1) * at(z, k).second;
  }

  int num_stages() const override { return kSteps + 1; }
  const StageSize& size(int k) const override { return sizes_[k]; }
  const Eigen::VectorXd& lower(int k) const override { return lower_[k]; }
  const Eigen::VectorXd& upper(int k) const override { return upper_[k]; }
  const StageValues& values(int k, const Eigen::VectorXd& ux) override {
    const auto [f, p, v] = unpack(k, ux);
    values_.cost = k < kSteps ? cost_of(f) : 0.0;
    values_.next = k < kSteps ? Eigen::VectorXd(next(f, p, v)) : Eigen::VectorXd();
    values_.equalities = k < kSteps ? Eigen::VectorXd() : Eigen::VectorXd(Eigen::Vector2d(p - task_.goal, v));
    values_.inequalities = Eigen::VectorXd::Constant(sizes_[k].inequalities, f);
    return values_;
  }
  const StageDerivatives& derivatives(int k, const Eigen::VectorXd& ux) override {
    const auto [f, p, v] = unpack(k, ux);
    const Eigen::Index n = ux.size();
    derivatives_.cost_gradient.setZero(n);
    derivatives_.next.setZero(k < kSteps ? 2 : 0, n);
    derivatives_.equalities = Eigen::MatrixXd::Identity(sizes_[k].equalities, n);
    derivatives_.inequalities = Eigen::MatrixXd::Identity(sizes_[k].inequalities, n);
    if (k == kSteps) return derivatives_;
    derivatives_.cost_gradient(0) = h * task_.curvature * f;
    derivatives_.next(1, 0) = h;
    if (k > 0) derivatives_.next.rightCols<2>() << 1.0, h, 0.0, 1.0 - 3.0 * h * v * v;
    if (++evaluations_ <= nan_after) return derivatives_;
    if (nan_in == Derivative::of_cost) derivatives_.cost_gradient(0) = NAN;
    if (nan_in == Derivative::of_next) derivatives_.next(1, 0) = NAN;
    if (nan_in == Derivative::of_inequalities) derivatives_.inequalities(0, 0) = NAN;
    return derivatives_;
  }
  const Eigen::MatrixXd& hessian(int k, const Eigen::VectorXd& ux, double cost_factor,
                                 const StageMultipliers& on) override {
    hessian_.setZero(ux.size(), ux.size());
    if (k == kSteps) return hessian_;
    hessian_(0, 0) = evaluations_ > nan_after && nan_in == Derivative::second ? NAN : cost_factor * h * task_.curvature;
    if (k > 0) hessian_(2, 2) = -6.0 * h * on.next(1) * ux(2);
    return hessian_;
  }
  std::vector<Eigen::VectorXd> stages(const Eigen::VectorXd& z) const override {
    std::vector<Eigen::VectorXd> result = {z.head<1>()};
    for (int k = 1; k <= kSteps; ++k) {
      Eigen::VectorXd ux(sizes_[k].variables());
      if (k < kSteps) ux(0) = z(3 * k);
      ux.tail<2>() = z.segment<2>(state(k));
      result.push_back(ux);
    }
    return result;
  }
  Eigen::VectorXd flat(const std::vector<Eigen::VectorXd>& stages) const override {
    Eigen::VectorXd z(3 * kSteps);
    for (int k = 0; k <= kSteps; ++k) {
      if (k < kSteps) z(3 * k) = stages[k](0);
      if (k > 0) z.segment<2>(state(k)) = stages[k].tail<2>();
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
  static std::pair<double, double> at(const Eigen::VectorXd& z, int k) {
    return k == 0 ? std::pair(0.0, 0.0) : std::pair(z(state(k)), z(state(k) + 1));
  }
  static Eigen::Vector2d next(double f, double p, double v) { return {p + h * v, v + h * (f - v * v * v)}; }
  double cost_of(double f) const { return std::abs(f) < nan_below ? NAN : 0.5 * h * task_.curvature * f * f; }
  std::tuple<double, double, double> unpack(int k, const Eigen::VectorXd& ux) const {
    const bool has_state = k > 0;
    return {k < kSteps ? ux(0) : 0.0, has_state ? ux(ux.size() - 2) : 0.0, has_state ? ux(ux.size() - 1) : 0.0};
  }

  CartTask task_;
  StageSize sizes_[kSteps + 1];
  Eigen::VectorXd lower_[kSteps + 1], upper_[kSteps + 1];
  StageValues values_;
  StageDerivatives derivatives_;
  Eigen::MatrixXd hessian_;
  int evaluations_ = 0;
};

}  // namespace prowl::test

#pragma once

#include <Eigen/Core>
#include <limits>
#include <string>

#include "prowl/nlp/nlp.hpp"

namespace prowl::test {

/// An Nlp with its bounds and patterns as data; a test problem fills them in and writes the functions.
class TestNlp : public Nlp {
 public:
  int num_variables() const override { return static_cast<int>(z_lower.size()); }
  int num_constraints() const override { return static_cast<int>(g_lower.size()); }
  const Eigen::VectorXd& variable_lower() const override { return z_lower; }
  const Eigen::VectorXd& variable_upper() const override { return z_upper; }
  const Eigen::VectorXd& constraint_lower() const override { return g_lower; }
  const Eigen::VectorXd& constraint_upper() const override { return g_upper; }
  const SparsityPattern& jacobian_pattern() const override { return jacobian_entries; }
  const SparsityPattern& hessian_pattern() const override { return hessian_entries; }
  std::string describe_constraint(int row) const override { return "constraint " + std::to_string(row); }
  std::string describe_variable(int index) const override { return "variable " + std::to_string(index); }

  static constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Eigen::VectorXd z_lower, z_upper, g_lower, g_upper;
  SparsityPattern jacobian_entries, hessian_entries;
};

/// Hock, Schittkowski 1981, problem 71:
///   minimise x0 x3 (x0 + x1 + x2) + x2   subject to   x0 x1 x2 x3 >= 25,  |x|^2 = 40,  1 <= x <= 5.
class Hs071 : public TestNlp {
 public:
  Hs071() {
    z_lower.setConstant(4, 1.0);
    z_upper.setConstant(4, 5.0);
    g_lower = Eigen::Vector2d(25.0, 40.0);
    g_upper = Eigen::Vector2d(kInfinity, 40.0);
    for (int row = 0; row < 2; ++row) {
      for (int col = 0; col < 4; ++col) add(jacobian_entries, row, col);
    }
    for (int row = 0; row < 4; ++row) {
      for (int col = 0; col <= row; ++col) add(hessian_entries, row, col);
    }
  }

  static Eigen::VectorXd guess() { return Eigen::Vector4d(1.0, 5.0, 5.0, 1.0); }

  double cost(const Eigen::VectorXd& x) override { return x[0] * x[3] * (x[0] + x[1] + x[2]) + x[2]; }

  void cost_gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> gradient) override {
    const double sum = x[0] + x[1] + x[2];
    gradient << x[3] * (sum + x[0]), x[0] * x[3], x[0] * x[3] + 1.0, x[0] * sum;
  }

  void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> g) override { g << x.prod(), x.squaredNorm(); }

  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    for (int i = 0; i < 4; ++i) {
      values[i] = x[(i + 1) % 4] * x[(i + 2) % 4] * x[(i + 3) % 4];
      values[4 + i] = 2.0 * x[i];
    }
  }

  void hessian(const Eigen::VectorXd& x, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    Eigen::Matrix4d h = Eigen::Matrix4d::Zero();  // lower triangle
    h(0, 0) = 2.0 * x[3];
    h(1, 0) = h(2, 0) = x[3];
    h(3, 0) = 2.0 * x[0] + x[1] + x[2];
    h(3, 1) = h(3, 2) = x[0];
    h *= cost_factor;
    for (int row = 0; row < 4; ++row) {
      h(row, row) += 2.0 * multipliers[1];
      for (int col = 0; col < row; ++col) {
        double others = 1.0;
        for (int i = 0; i < 4; ++i) others *= (i == row || i == col) ? 1.0 : x[i];
        h(row, col) += multipliers[0] * others;
      }
    }
    for (int i = 0; i < hessian_entries.size(); ++i) values[i] = h(hessian_entries.rows[i], hessian_entries.cols[i]);
  }

 protected:
  static void add(SparsityPattern& pattern, int row, int col) {
    pattern.rows.push_back(row);
    pattern.cols.push_back(col);
  }
};

}  // namespace prowl::test

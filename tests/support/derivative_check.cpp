#include "tests/support/derivative_check.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <sstream>
#include <utility>

namespace prowl::test {
namespace {

/// A sparse matrix column by column, as differences come.
class Columns {
 public:
  Columns(const SparsityPattern& pattern, const Eigen::VectorXd& values, int num_cols) : entries_(num_cols) {
    for (int i = 0; i < pattern.size(); ++i) {
      if (pattern.cols[i] >= 0 && pattern.cols[i] < num_cols) {
        entries_[pattern.cols[i]].emplace_back(pattern.rows[i], values[i]);
      }
    }
  }
  const std::vector<std::pair<int, double>>& col(int j) const { return entries_[j]; }

 private:
  std::vector<std::vector<std::pair<int, double>>> entries_;
};

using Names = std::function<std::string(int row, int col)>;

void note(DerivativeError& worst, double value, double difference, int row, int col, const Names& name) {
  const double relative = std::abs(value - difference) / std::max({1.0, std::abs(value), std::abs(difference)});
  const bool not_a_number = std::isnan(relative);
  if (!not_a_number && relative <= worst.relative && worst.row >= 0) return;
  if (std::isinf(worst.relative)) return;
  worst = {not_a_number ? INFINITY : relative, value, difference, row, col, name(row, col)};
}

/// Compares one column; what the pattern does not have must be zero. Rows below first_row are not the pattern's
/// business.
void compare_column(const Columns& matrix, const Eigen::VectorXd& difference, int col, int first_row, double tolerance,
                    const Names& name, DerivativeError& worst, std::vector<std::string>& faults) {
  Eigen::VectorXd rest = difference;
  for (const auto& [row, value] : matrix.col(col)) {
    if (row < 0 || row >= difference.size()) continue;  // reported by check_footholds
    note(worst, value, difference[row], row, col, name);
    rest[row] = 0.0;
  }
  for (int row = first_row; row < rest.size(); ++row) {
    if (std::abs(rest[row]) <= tolerance) continue;
    std::ostringstream fault;
    fault << name(row, col) << ": derivative " << rest[row] << " is not in the sparsity pattern";
    faults.push_back(fault.str());
  }
}

void check_pattern(const char* matrix, const SparsityPattern& pattern, int num_rows, int num_cols, bool lower_triangle,
                   std::vector<std::string>& faults) {
  std::set<std::pair<int, int>> seen;
  for (int i = 0; i < pattern.size(); ++i) {
    const int row = pattern.rows[i];
    const int col = pattern.cols[i];
    const char* fault = nullptr;
    if (row < 0 || row >= num_rows || col < 0 || col >= num_cols)
      fault = "is outside the matrix";
    else if (lower_triangle && row < col)
      fault = "is above the diagonal";
    else if (!seen.insert({row, col}).second)
      fault = "is in the sparsity pattern twice";
    if (!fault) continue;
    std::ostringstream text;
    text << matrix << " (" << row << ", " << col << ") " << fault;
    faults.push_back(text.str());
  }
}

/// Value and first derivatives at one point.
class Evaluation {
 public:
  explicit Evaluation(Nlp& nlp)
      : nlp_(nlp),
        g_(nlp.num_constraints()),
        gradient_(nlp.num_variables()),
        jacobian_(nlp.jacobian_pattern().size()) {}

  Eigen::VectorXd constraints(const Eigen::VectorXd& z) {
    nlp_.constraints(z, g_);
    return g_;
  }

  Eigen::VectorXd lagrangian_gradient(const Eigen::VectorXd& z, double cost_factor,
                                      const Eigen::VectorXd& multipliers) {
    nlp_.cost_gradient(z, gradient_);
    nlp_.jacobian(z, jacobian_);
    Eigen::VectorXd result = cost_factor * gradient_;
    const SparsityPattern& pattern = nlp_.jacobian_pattern();
    for (int i = 0; i < pattern.size(); ++i) result[pattern.cols[i]] += jacobian_[i] * multipliers[pattern.rows[i]];
    return result;
  }

 private:
  Nlp& nlp_;
  Eigen::VectorXd g_, gradient_, jacobian_;
};

}  // namespace

double DerivativeReport::worst() const { return std::max({gradient.relative, jacobian.relative, hessian.relative}); }

std::string DerivativeReport::summary() const {
  std::ostringstream text;
  const auto line = [&text](const char* what, const DerivativeError& error) {
    text << what << ": " << error.relative << " relative at " << error.where << " (given " << error.value
         << ", difference " << error.difference << ")\n";
  };
  line("gradient", gradient);
  line("Jacobian", jacobian);
  line("Hessian", hessian);
  for (const std::string& fault : pattern_faults) text << fault << "\n";
  return text.str();
}

DerivativeReport check_derivatives(Nlp& nlp, const Eigen::VectorXd& z, double cost_factor,
                                   const Eigen::VectorXd& multipliers, const DerivativeCheckOptions& options) {
  const int n = nlp.num_variables();
  DerivativeReport report;
  check_pattern("Jacobian", nlp.jacobian_pattern(), nlp.num_constraints(), n, false, report.pattern_faults);
  check_pattern("Hessian", nlp.hessian_pattern(), n, n, true, report.pattern_faults);
  if (!report.pattern_faults.empty()) return report;  // the values have no place to be compared at

  Eigen::VectorXd gradient(n), jacobian(nlp.jacobian_pattern().size()), hessian(nlp.hessian_pattern().size());
  nlp.cost_gradient(z, gradient);
  nlp.jacobian(z, jacobian);
  nlp.hessian(z, cost_factor, multipliers, hessian);
  const Columns jacobian_columns(nlp.jacobian_pattern(), jacobian, n);
  const Columns hessian_columns(nlp.hessian_pattern(), hessian, n);

  const Names variable = [&nlp](int, int col) { return nlp.describe_variable(col); };
  const Names constraint = [&nlp](int row, int col) {
    return nlp.describe_constraint(row) + " by " + nlp.describe_variable(col);
  };
  const Names variables = [&nlp](int row, int col) {
    return nlp.describe_variable(row) + " by " + nlp.describe_variable(col);
  };

  Evaluation at(nlp);
  for (int j = 0; j < n; ++j) {
    const double h = options.step * std::max(1.0, std::abs(z[j]));
    // Fourth order: second-order differences cannot tell a mistake of 1e-6 from what bends.
    const auto difference = [&](const auto& value) {
      const auto at_distance = [&](double distance) {
        Eigen::VectorXd moved = z;
        moved[j] += distance;
        return value(moved);
      };
      return Eigen::VectorXd(
          (8.0 * (at_distance(h) - at_distance(-h)) - (at_distance(2.0 * h) - at_distance(-2.0 * h))) / (12.0 * h));
    };
    const Eigen::VectorXd cost = difference(
        [&](const Eigen::VectorXd& x) -> Eigen::VectorXd { return Eigen::VectorXd::Constant(1, nlp.cost(x)); });
    note(report.gradient, gradient[j], cost[0], 0, j, variable);
    const Eigen::VectorXd dg = difference([&](const Eigen::VectorXd& x) { return at.constraints(x); });
    compare_column(jacobian_columns, dg, j, 0, options.outside_tolerance, constraint, report.jacobian,
                   report.pattern_faults);
    const Eigen::VectorXd dl =
        difference([&](const Eigen::VectorXd& x) { return at.lagrangian_gradient(x, cost_factor, multipliers); });
    compare_column(hessian_columns, dl, j, j, options.outside_tolerance, variables, report.hessian,
                   report.pattern_faults);
  }
  return report;
}

}  // namespace prowl::test

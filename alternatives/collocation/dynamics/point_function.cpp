#include "alternatives/collocation/dynamics/point_function.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

PointFunction::PointFunction(ChartedNode& node, const Instant& instant, std::vector<int> rows)
    : node_(node), instant_(instant), rows_(std::move(rows)) {}

void PointFunction::fill(VectorXd& y) const {
  const auto count = static_cast<Index>(rows_.size());
  y.resize(count + 1);
  for (Index i = 0; i < count; ++i) y(i) = values_.rows(rows_[i]);
  y(count) = values_.cost;
}

void PointFunction::evaluate(const VectorXd& x, VectorXd& y) {
  columns_ = x;
  node_.evaluate(instant_, columns_, values_);
  fill(y);
}

void PointFunction::evaluate_with_derivatives(const VectorXd& x, VectorXd& y, MatrixXd& dy) {
  columns_ = x;
  node_.evaluate_with_derivatives(instant_, columns_, values_);
  fill(y);
  dy.resize(y.size(), node_.num_columns());
  for (std::size_t i = 0; i < rows_.size(); ++i) dy.row(static_cast<Index>(i)) = values_.rows_jacobian.row(rows_[i]);
  dy.bottomRows(1) = values_.cost_gradient.transpose();
}

VectorXd PointFunction::multipliers_of_rows(const VectorXd& weights) const {
  VectorXd multipliers = VectorXd::Zero(node_.num_rows(instant_.node));
  for (std::size_t i = 0; i < rows_.size(); ++i) multipliers(rows_[i]) = weights(static_cast<Index>(i));
  return multipliers;
}

void PointFunction::hessian_of_columns(double cost_factor, const VectorXd& multipliers, MatrixXd& result) {
  node_.hessian(instant_, columns_, cost_factor, multipliers, result);
}

void PointFunction::hessian(const VectorXd& /*x*/, const VectorXd& weights, MatrixXd& result) {
  hessian_of_columns(weights(weights.size() - 1), multipliers_of_rows(weights), result);
}

}  // namespace prowl

#include "prowl/formulations/point_function.hpp"

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

PointFunction::PointFunction(ChartedNode& node, const Instant& instant, bool eliminates_acceleration,
                             std::vector<int> rows)
    : node_(node),
      instant_(instant),
      eliminates_(eliminates_acceleration),
      rows_(std::move(rows)),
      nv_(static_cast<int>(node.num_dofs())),
      num_inputs_(node.num_columns() - acceleration_size()) {}

// The dynamics are linear in a: one step of Newton's method from a = 0.
void PointFunction::set_columns(const VectorXd& x) {
  if (!eliminates_) {
    columns_ = x;
    return;
  }
  if (last_inputs_.size() == x.size() && last_inputs_ == x) return;
  last_inputs_.resize(0);
  columns_.resize(node_.num_columns());
  columns_ << x.head(2 * nv_), VectorXd::Zero(nv_), x.tail(x.size() - 2 * nv_);
  node_.evaluate_with_derivatives(instant_, columns_, values_);
  dynamics_.compute(values_.rows_jacobian.block(0, 2 * nv_, nv_, nv_));
  columns_.segment(2 * nv_, nv_) = dynamics_.solve(-values_.rows.head(nv_));
  last_inputs_ = x;
}

void PointFunction::fill(VectorXd& y) const {
  y.resize(num_outputs());
  if (eliminates_) y.head(nv_) = columns_.segment(2 * nv_, nv_);
  for (std::size_t i = 0; i < rows_.size(); ++i) y(acceleration_size() + static_cast<Index>(i)) = values_.rows(rows_[i]);
  y(y.size() - 1) = values_.cost;
}

void PointFunction::evaluate(const VectorXd& x, VectorXd& y) {
  set_columns(x);
  node_.evaluate(instant_, columns_, values_);
  fill(y);
}

void PointFunction::set_tangent() {
  if (!eliminates_) return;
  const MatrixXd& J = values_.rows_jacobian;
  MatrixXd others(nv_, num_inputs_);
  others << J.topLeftCorner(nv_, 2 * nv_), J.topRightCorner(nv_, num_inputs_ - 2 * nv_);
  acceleration_slope_ = dynamics_.solve(-others);
}

MatrixXd PointFunction::compressed(const MatrixXd& m) const {
  if (!eliminates_) return m;
  MatrixXd result(m.rows(), num_inputs_);
  result << m.leftCols(2 * nv_), m.rightCols(num_inputs_ - 2 * nv_);
  result.noalias() += m.middleCols(2 * nv_, nv_) * acceleration_slope_;
  return result;
}

void PointFunction::evaluate_with_derivatives(const VectorXd& x, VectorXd& y, MatrixXd& dy) {
  set_columns(x);
  node_.evaluate_with_derivatives(instant_, columns_, values_);
  fill(y);
  set_tangent();
  MatrixXd kept(static_cast<Index>(rows_.size()) + 1, node_.num_columns());
  for (std::size_t i = 0; i < rows_.size(); ++i) kept.row(static_cast<Index>(i)) = values_.rows_jacobian.row(rows_[i]);
  kept.bottomRows(1) = values_.cost_gradient.transpose();
  dy.resize(num_outputs(), num_inputs_);
  if (eliminates_) dy.topRows(nv_) = acceleration_slope_;
  dy.bottomRows(kept.rows()) = compressed(kept);
}

void PointFunction::hessian(const VectorXd& /*x*/, const VectorXd& weights, MatrixXd& result) {
  VectorXd multipliers = VectorXd::Zero(node_.num_rows(instant_.node));
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    multipliers(rows_[i]) = weights(acceleration_size() + static_cast<Index>(i));
  }
  const double cost_factor = weights(weights.size() - 1);
  if (eliminates_) {
    const VectorXd on_acceleration = weights.head(nv_) +
                                     values_.rows_jacobian.middleCols(2 * nv_, nv_).transpose() * multipliers +
                                     cost_factor * values_.cost_gradient.segment(2 * nv_, nv_);
    multipliers.head(nv_) = -VectorXd(dynamics_.transpose().solve(on_acceleration));
  }
  MatrixXd all;
  node_.hessian(instant_, columns_, cost_factor, multipliers, all);
  if (!eliminates_) {
    result = all;
    return;
  }
  result = compressed(compressed(all).transpose());
}

}  // namespace prowl

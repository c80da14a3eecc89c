#pragma once

#include <vector>

#include "alternatives/collocation/charted_node.hpp"
#include "alternatives/collocation/graph/differentiable_function.hpp"

namespace prowl {

/// The dynamics at one instant as a node of a ProgramGraph, with the acceleration as an input:
///
///   (x, v, a, tau, w, shared)  ->  (rows, cost)
///
/// If the acceleration is eliminated, it is the first output instead of an input
/// (eliminated_acceleration.cpp).
class PointFunction : public DifferentiableFunction {
 public:
  /// `rows`: rows of ChartedNode to output. Keeps a reference to the node.
  PointFunction(ChartedNode& node, const Instant& instant, std::vector<int> rows);

  int num_inputs() const override { return node_.num_columns(); }
  int num_outputs() const override { return acceleration_size() + static_cast<int>(rows_.size()) + 1; }
  /// Size of the acceleration among the outputs.
  virtual int acceleration_size() const { return 0; }
  const std::vector<int>& rows() const { return rows_; }

  void evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& y) override;
  void evaluate_with_derivatives(const Eigen::VectorXd& x, Eigen::VectorXd& y, Eigen::MatrixXd& dy) override;
  void hessian(const Eigen::VectorXd& x, const Eigen::VectorXd& weights, Eigen::MatrixXd& result) override;

  /// All columns of ChartedNode of the last evaluation, including the acceleration.
  const Eigen::VectorXd& columns() const { return columns_; }
  const Eigen::VectorXd& forces() const { return values_.forces; }  ///< 3 per contact of the phase, world frame [N]

 protected:
  /// Values of the node at the columns of the last evaluation.
  const ChartedNode::Values& values() const { return values_; }
  /// Multipliers of all rows of the node, from weights of (rows, cost).
  Eigen::VectorXd multipliers_of_rows(const Eigen::VectorXd& weights) const;
  void hessian_of_columns(double cost_factor, const Eigen::VectorXd& multipliers, Eigen::MatrixXd& result);

 private:
  void fill(Eigen::VectorXd& y) const;

  ChartedNode& node_;
  Instant instant_;
  std::vector<int> rows_;
  Eigen::VectorXd columns_;
  ChartedNode::Values values_;
};

}  // namespace prowl

#pragma once

#include <Eigen/LU>
#include <vector>

#include "prowl/formulations/charted_node.hpp"
#include "prowl/formulations/function.hpp"

namespace prowl {

/// The dynamics at one instant as a node of a ProgramGraph.
///
/// With acceleration as an input (inverse and KKT form):  (x, v, a, tau, w, shared)  ->  (rows, cost)
/// and eliminated (forward form):                         (x, v, tau, w, shared)     ->  (a, rows, cost)
///
/// Eliminated, a is what solves the dynamics c(q, v, a, tau) = 0, which is linear in a: that of Pardo et al. 2016, with the
/// missing P restored. Its derivatives follow from those of c: da = -c_a^-1 dc, and the Hessian of ν · a + μ · (rows, cost) is
/// Tᵀ H T, with T the derivative of all columns in the inputs and H the Hessian of μ · (rows, cost) + λ · c, where λ is such that
/// the gradient in a vanishes.
class PointFunction : public Function {
 public:
  /// `rows`: which of ChartedNode's come out; of those of the dynamics none if a is eliminated. Keeps a reference to the node.
  PointFunction(ChartedNode& node, const Instant& instant, bool eliminates_acceleration, std::vector<int> rows);

  int num_inputs() const override { return num_inputs_; }
  int num_outputs() const override { return acceleration_size() + static_cast<int>(rows_.size()) + 1; }
  int acceleration_size() const { return eliminates_ ? nv_ : 0; }
  const std::vector<int>& rows() const { return rows_; }

  void evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& y) override;
  void evaluate_with_derivatives(const Eigen::VectorXd& x, Eigen::VectorXd& y, Eigen::MatrixXd& dy) override;
  void hessian(const Eigen::VectorXd& x, const Eigen::VectorXd& weights, Eigen::MatrixXd& result) override;

  /// All columns of ChartedNode at the inputs of the last evaluation, the acceleration among them.
  const Eigen::VectorXd& columns() const { return columns_; }
  const Eigen::VectorXd& forces() const { return values_.forces; }  ///< 3 per contact of the phase, world frame [N]

 private:
  void set_columns(const Eigen::VectorXd& x);
  /// Derivative of all columns in the inputs.
  void set_tangent();
  void fill(Eigen::VectorXd& y) const;
  Eigen::MatrixXd compressed(const Eigen::MatrixXd& columns) const;  ///< columns * tangent

  ChartedNode& node_;
  Instant instant_;
  bool eliminates_;
  std::vector<int> rows_;
  int nv_, num_inputs_;
  Eigen::VectorXd last_inputs_, columns_;
  ChartedNode::Values values_;
  Eigen::PartialPivLU<Eigen::MatrixXd> dynamics_;  ///< of c_a
  Eigen::MatrixXd acceleration_slope_;             ///< of a in the inputs
};

}  // namespace prowl

#pragma once

#include "alternatives/collocation/charts/base_chart.hpp"
#include "alternatives/collocation/graph/differentiable_function.hpp"

namespace prowl {

/// Rates of the coordinates x = (base position, rotation e, joints) from the velocity v = (base twist in the base
/// frame, joint rates):
///
///   ṗ = R(e) v_linear,   ė = E(e)⁻¹ ω,   joints: their rates                   [m/s, rad/s]
///
/// Inputs (x, v), 2 nv; outputs ẋ, nv.
class RateFunction : public DifferentiableFunction {
 public:
  RateFunction(const BaseChart& chart, int nv) : chart_(chart), nv_(nv) {}

  int num_inputs() const override { return 2 * nv_; }
  int num_outputs() const override { return nv_; }
  bool depends(int i, int j) const override;
  bool bends(int i, int j) const override;
  void evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& y) override;
  void evaluate_with_derivatives(const Eigen::VectorXd& x, Eigen::VectorXd& y, Eigen::MatrixXd& dy) override;
  void hessian(const Eigen::VectorXd& x, const Eigen::VectorXd& weights, Eigen::MatrixXd& result) override;

 private:
  const BaseChart& chart_;
  int nv_;
};

}  // namespace prowl

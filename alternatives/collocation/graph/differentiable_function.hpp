#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

namespace prowl {

/// A smooth vector function y(x) with exact derivatives: a node of a ProgramGraph.
class DifferentiableFunction {
 public:
  virtual ~DifferentiableFunction() = default;

  virtual int num_inputs() const = 0;
  virtual int num_outputs() const = 0;
  /// True if dy_i/dx_j may be non-zero; default: all.
  virtual bool depends(int /*i*/, int /*j*/) const { return true; }
  /// True if a second derivative of y in x_i and x_j may be non-zero; default: all.
  virtual bool bends(int /*i*/, int /*j*/) const { return true; }

  virtual void evaluate(const Eigen::VectorXd& x, Eigen::VectorXd& y) = 0;
  /// y and dy/dx, num_outputs() x num_inputs().
  virtual void evaluate_with_derivatives(const Eigen::VectorXd& x, Eigen::VectorXd& y, Eigen::MatrixXd& dy) = 0;
  /// Hessian of weights . y, num_inputs() square, symmetric; x of the last
  /// evaluate_with_derivatives().
  virtual void hessian(const Eigen::VectorXd& x, const Eigen::VectorXd& weights, Eigen::MatrixXd& result) = 0;
};

}  // namespace prowl

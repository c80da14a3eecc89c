#pragma once

#include <Eigen/Core>

namespace prowl {

struct StageSize {
  int inputs = 0, states = 0, equalities = 0, inequalities = 0;
  int variables() const { return inputs + states; }
};

/// Derivatives of a chain of stages k = 0 ... num_stages() - 1 at one point, as dynamic programming needs them: stage k
/// has the variables (u_k, x_k), inputs and states, and
///
///   x_{k+1} = next_k(u_k, x_k)   (not after the last stage),   equalities_k(u_k, x_k) = 0,   inequalities_k(u_k, x_k)
///
/// What a stage returns is valid until it is linearised again.
class LinearisedChain {
 public:
  virtual ~LinearisedChain() = default;

  virtual int num_stages() const = 0;
  virtual const StageSize& size(int k) const = 0;
  /// Closes the chain: the last equalities of the last stage are in truth
  ///   equalities.tail(rows) + closure() * (u_0, x_0) = 0,
  /// one row each. Without rows, as usual, the chain is open.
  virtual const Eigen::MatrixXd& closure() const {
    static const Eigen::MatrixXd open;
    return open;
  }

  virtual const Eigen::MatrixXd& equality_slopes(int k) const = 0;
  /// The lower triangle of the Hessian of the Lagrangian; above it the matrix is undefined.
  virtual const Eigen::MatrixXd& lagrangian_hessian(int k) const = 0;
  /// result += next' next_hessian next + inequalities' diag(weights) inequalities, with the derivatives of both: the
  /// lower triangle. Above it the result is undefined afterwards.
  virtual void add_condensed(int k, const Eigen::MatrixXd& next_hessian, const Eigen::VectorXd& weights,
                             Eigen::MatrixXd& result) = 0;
  /// Derivatives of next and of the inequalities along a step in (u, x).
  virtual void push_forward(int k, const Eigen::VectorXd& step, Eigen::VectorXd& next,
                            Eigen::VectorXd& inequalities) = 0;
  /// gradient += next' on_next + inequalities' on_inequalities; an empty vector is left out.
  virtual void add_pull_back(int k, const Eigen::VectorXd& on_next, const Eigen::VectorXd& on_inequalities,
                             Eigen::VectorXd& gradient) = 0;
};

}  // namespace prowl

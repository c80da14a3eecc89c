#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include "prowl/linear_algebra/matrix_kernels.hpp"

namespace prowl {

/// Derivatives of one stage of a chain (LinearisedChain) in its variables (u, x).
struct StageSlopes {
  Eigen::VectorXd cost_gradient;
  Eigen::MatrixXd equalities;          ///< one row per equality
  Eigen::MatrixXd hessian;             ///< of the Lagrangian: its lower triangle
  Eigen::MatrixXd rows;                ///< inequalities that are rows of the node: a column per gradient
  Eigen::SparseMatrix<double> bounds;  ///< those that are bounds, which follow: likewise
  Eigen::SparseMatrix<double> next;    ///< one row per state of the next stage; empty in the last stage

  Eigen::Index num_inequalities() const { return rows.cols() + bounds.cols(); }
  void push_forward(const Eigen::VectorXd& step, Eigen::VectorXd& next_step, Eigen::VectorXd& inequalities) const;
  void add_pull_back(const Eigen::VectorXd& on_next, const Eigen::VectorXd& on_inequalities,
                     Eigen::VectorXd& gradient) const;
};

/// LinearisedChain::add_condensed() of a stage, with its work space.
class StageCondenser {
 public:
  void add(const StageSlopes& stage, const Eigen::MatrixXd& next_hessian, const Eigen::VectorXd& weights,
           Eigen::MatrixXd& result);

 private:
  MatrixKernels kernels_;
  Eigen::MatrixXd bounded_, weighted_, on_states_, on_states_transposed_;
};

}  // namespace prowl

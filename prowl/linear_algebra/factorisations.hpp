#pragma once

#include <Eigen/Core>

namespace prowl {

/// Factorisations of dense matrices of any size, for use outside the inner loops. Eigen's templates for them take
/// seconds to compile, hence they are compiled once.

/// Eigenvalues in increasing order and their unit eigenvectors, one per column.
struct SymmetricEigen {
  Eigen::VectorXd values;
  Eigen::MatrixXd vectors;
};
SymmetricEigen symmetric_eigen(const Eigen::MatrixXd& A);  ///< of a symmetric A; reads its lower triangle

Eigen::VectorXcd eigenvalues(const Eigen::MatrixXd& A);     ///< of a square A
Eigen::VectorXd singular_values(const Eigen::MatrixXd& A);  ///< in decreasing order
Eigen::MatrixXd exponential(const Eigen::MatrixXd& A);      ///< e^A of a square A

/// The x of least norm that minimises |A x - b|. Pivots below `threshold` times the largest count as zero.
Eigen::VectorXd least_norm_solution(const Eigen::MatrixXd& A, const Eigen::VectorXd& b, double threshold);

/// A X = B with least squares, damped where A is nearly singular, as with straight legs: (AᵀA + d I)⁻¹ Aᵀ B with d a
/// thousandth of the largest diagonal entry of AᵀA. Below 3 % of the longest column a direction counts as singular.
Eigen::MatrixXd damped_solution(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B);

}  // namespace prowl

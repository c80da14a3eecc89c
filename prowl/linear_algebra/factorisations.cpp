#include "prowl/linear_algebra/factorisations.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <limits>
#include <unsupported/Eigen/MatrixFunctions>

namespace prowl {

using Eigen::MatrixXd;
using Eigen::VectorXd;

SymmetricEigen symmetric_eigen(const MatrixXd& A) {
  const Eigen::SelfAdjointEigenSolver<MatrixXd> solver(A);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

Eigen::VectorXcd eigenvalues(const MatrixXd& A) { return A.eigenvalues(); }

VectorXd singular_values(const MatrixXd& A) { return Eigen::JacobiSVD<MatrixXd>(A).singularValues(); }

MatrixXd exponential(const MatrixXd& A) { return A.exp(); }

VectorXd least_norm_solution(const MatrixXd& A, const VectorXd& b, double threshold) {
  Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors;
  factors.setThreshold(threshold);
  factors.compute(A);
  return factors.solve(b);
}

MatrixXd damped_solution(const MatrixXd& A, const MatrixXd& B) {
  constexpr double kSingular = 1e-3;
  MatrixXd gram = A.transpose() * A;
  gram.diagonal().array() += std::max(kSingular * gram.diagonal().maxCoeff(), std::numeric_limits<double>::min());
  return gram.llt().solve(A.transpose() * B);
}

}  // namespace prowl

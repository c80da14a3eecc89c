#include "prowl/linear_algebra/factorisations.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

MatrixXd random_matrix(int rows, int columns, unsigned seed) {
  std::mt19937 rng(seed);
  std::normal_distribution<double> normal;
  return MatrixXd::NullaryExpr(rows, columns, [&] { return normal(rng); });
}

TEST(Factorisations, EigenvectorsOfASymmetricMatrixAreScaledByTheirEigenvalues) {
  const MatrixXd root = random_matrix(7, 7, 1), A = root + root.transpose();
  const SymmetricEigen eigen = symmetric_eigen(A);
  EXPECT_LT((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), 1e-12);
  EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - MatrixXd::Identity(7, 7)).norm(), 1e-12);
  for (int i = 1; i < 7; ++i) EXPECT_LE(eigen.values(i - 1), eigen.values(i));
}

TEST(Factorisations, EigenvaluesHaveTraceAndDeterminant) {
  const MatrixXd A = random_matrix(6, 6, 2);
  const Eigen::VectorXcd values = eigenvalues(A);
  EXPECT_LT(std::abs(values.sum() - A.trace()), 1e-12);
  EXPECT_LT(std::abs(values.prod() - A.determinant()), 1e-10);
}

TEST(Factorisations, SquaredSingularValuesAreEigenvaluesOfTheGramMatrix) {
  const MatrixXd A = random_matrix(4, 9, 3);
  const VectorXd squares = singular_values(A).array().square();
  EXPECT_LT((squares.reverse() - symmetric_eigen(A * A.transpose()).values).norm(), 1e-12);
}

TEST(Factorisations, ExponentialIsTheSeriesOfMatrixPowers) {
  const MatrixXd A = random_matrix(5, 5, 4);
  MatrixXd sum = MatrixXd::Identity(5, 5), term = sum;
  for (int k = 1; k < 60; ++k) sum += term = (term * A / k).eval();
  EXPECT_LT((exponential(A) - sum).norm(), 1e-12 * sum.norm());
}

TEST(Factorisations, LeastNormSolutionIsTheShortestOfTheBest) {
  // Rank 2 of 4 rows and 6 columns: neither solvable nor unique.
  const MatrixXd A = random_matrix(4, 2, 5) * random_matrix(2, 6, 6);
  const VectorXd b = random_matrix(4, 1, 7), x = least_norm_solution(A, b, 1e-9);
  EXPECT_LT((A.transpose() * (A * x - b)).norm(), 1e-12);                                      // best
  EXPECT_LT((x - A.transpose() * least_norm_solution(A.transpose(), x, 1e-9)).norm(), 1e-12);  // in the row space
}

}  // namespace
}  // namespace prowl

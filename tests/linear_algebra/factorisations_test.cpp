#include "prowl/linear_algebra/factorisations.hpp"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

TEST(Factorisations, EigenvectorsOfASymmetricMatrixAreScaledByTheirEigenvalues) {
  std::mt19937 rng(1);
  const MatrixXd root = test::random_matrix(rng, 7, 7), A = root + root.transpose();
  const SymmetricEigen eigen = symmetric_eigen(A);
  EXPECT_LT((A * eigen.vectors - eigen.vectors * eigen.values.asDiagonal()).norm(), 1e-12);
  EXPECT_LT((eigen.vectors.transpose() * eigen.vectors - MatrixXd::Identity(7, 7)).norm(), 1e-12);
  for (int i = 1; i < 7; ++i) EXPECT_LE(eigen.values(i - 1), eigen.values(i));
}

TEST(Factorisations, EigenvaluesHaveTraceAndDeterminant) {
  std::mt19937 rng(2);
  const MatrixXd A = test::random_matrix(rng, 6, 6);
  const Eigen::VectorXcd values = eigenvalues(A);
  EXPECT_LT(std::abs(values.sum() - A.trace()), 1e-12);
  EXPECT_LT(std::abs(values.prod() - A.determinant()), 1e-10);
}

TEST(Factorisations, SquaredSingularValuesAreEigenvaluesOfTheGramMatrix) {
  std::mt19937 rng(3);
  const MatrixXd A = test::random_matrix(rng, 4, 9);
  const VectorXd squares = singular_values(A).array().square();
  EXPECT_LT((squares.reverse() - symmetric_eigen(A * A.transpose()).values).norm(), 1e-12);
}

TEST(Factorisations, ExponentialIsTheSeriesOfMatrixPowers) {
  std::mt19937 rng(4);
  const MatrixXd A = test::random_matrix(rng, 5, 5);
  MatrixXd sum = MatrixXd::Identity(5, 5), term = sum;
  for (int k = 1; k < 60; ++k) sum += term = (term * A / k).eval();
  EXPECT_LT((exponential(A) - sum).norm(), 1e-12 * sum.norm());
}

TEST(Factorisations, LeastNormSolutionIsTheShortestOfTheBest) {
  // Rank 2 of 4 rows and 6 columns: neither solvable nor unique.
  std::mt19937 rng(5);
  const MatrixXd left = test::random_matrix(rng, 4, 2), A = left * test::random_matrix(rng, 2, 6);
  const VectorXd b = test::random_vector(rng, 4, 1.0), x = least_norm_solution(A, b, 1e-9);
  EXPECT_LT((A.transpose() * (A * x - b)).norm(), 1e-12);                                      // best
  EXPECT_LT((x - A.transpose() * least_norm_solution(A.transpose(), x, 1e-9)).norm(), 1e-12);  // in the row space
}

TEST(Factorisations, DampedSolutionSolvesButForDirectionsThatAreNearlySingular) {
  const MatrixXd A = MatrixXd::Random(9, 4), X = MatrixXd::Random(4, 3);
  EXPECT_LT((damped_solution(A, A * X) - X).norm(), 0.02 * X.norm());
  MatrixXd flat = MatrixXd::Identity(2, 2);
  flat(1, 1) = 1e-6;
  const Eigen::VectorXd x = damped_solution(flat, Eigen::Vector2d(1.0, 1.0));
  EXPECT_NEAR(x(0), 1.0, 2e-3);
  EXPECT_NEAR(x(1), 0.0, 2e-3) << "1e6 without damping";
  EXPECT_EQ(damped_solution(MatrixXd::Zero(3, 2), MatrixXd::Ones(3, 1)).norm(), 0.0);
}

}  // namespace
}  // namespace prowl

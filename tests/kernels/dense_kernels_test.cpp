// Both instruction sets against Eigen, for all sizes around those of blocks.
#include "prowl/kernels/dense_kernels.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/SparseCore>
#include <cmath>
#include <string>
#include <vector>

#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using test::random_matrix;

const std::vector<int> kSizes = {0, 1, 2, 3, 4, 5, 7, 8, 12, 13, 18, 25, 36};

std::vector<const DenseKernels*> sets() {
  std::vector<const DenseKernels*> all = {&kernels_x86_64};
  if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma")) all.push_back(&kernels_x86_64_v3);
  return all;
}

/// Columns farther apart than the matrix has rows, with something between them.
MatrixXd padded(const MatrixXd& matrix) {
  MatrixXd all = MatrixXd::Constant(matrix.rows() + 3, matrix.cols(), 1e300);
  all.topRows(matrix.rows()) = matrix;
  return all;
}

void expect_near(const MatrixXd& found, const MatrixXd& expected, const std::string& what) {
  ASSERT_EQ(found.rows(), expected.rows()) << what;
  if (expected.size() == 0) return;
  EXPECT_LT((found - expected).cwiseAbs().maxCoeff(), 1e-12 * (1.0 + expected.cwiseAbs().maxCoeff())) << what;
}

void expect_padding(const MatrixXd& all) { EXPECT_TRUE((all.bottomRows(3).array() == 1e300).all()) << "wrote outside"; }

MatrixXd lower(const MatrixXd& matrix) { return matrix.triangularView<Eigen::Lower>(); }

TEST(DenseKernels, SetAndAddProducts) {
  std::mt19937 rng(1);
  for (const DenseKernels* kernels : sets()) {
    for (const int rows : kSizes) {
      for (const int cols : kSizes) {
        for (const int inner : {0, 1, 5, 18}) {
          const MatrixXd A = random_matrix(rng, rows, inner), B = random_matrix(rng, inner, cols);
          const MatrixXd C = random_matrix(rng, rows, cols), a = padded(A), Bt = B.transpose();
          for (const bool transposed : {false, true}) {
            MatrixXd c = padded(C);
            kernels->add_product(rows, cols, inner, -0.7, a.data(), rows + 3, transposed ? Bt.data() : B.data(),
                                 transposed ? cols : 1, transposed ? 1 : inner, c.data(), rows + 3);
            expect_near(c.topRows(rows), C - 0.7 * A * B, kernels->instruction_set);
            expect_padding(c);
            c.topRows(rows).setConstant(std::nan(""));
            kernels->set_product(rows, cols, inner, -0.7, a.data(), rows + 3, transposed ? Bt.data() : B.data(),
                                 transposed ? cols : 1, transposed ? 1 : inner, c.data(), rows + 3);
            expect_near(c.topRows(rows), -0.7 * A * B, kernels->instruction_set);
            expect_padding(c);
          }
        }
      }
    }
  }
}

TEST(DenseKernels, SetAndAddTheLowerTriangleOfAProduct) {
  std::mt19937 rng(2);
  for (const DenseKernels* kernels : sets()) {
    for (const int size : kSizes) {
      for (const int inner : {0, 1, 5, 18}) {
        const MatrixXd A = random_matrix(rng, size, inner), B = random_matrix(rng, size, inner);
        const MatrixXd C = random_matrix(rng, size, size);
        MatrixXd c = padded(C);
        kernels->add_lower_product(size, inner, 2.0, A.data(), size, B.data(), size, c.data(), size + 3);
        expect_near(lower(c.topRows(size)), lower(C + 2.0 * A * B.transpose()), kernels->instruction_set);
        expect_padding(c);
        c.topRows(size).setConstant(std::nan(""));
        kernels->set_lower_product(size, inner, 2.0, A.data(), size, B.data(), size, c.data(), size + 3);
        expect_near(lower(c.topRows(size)), lower(2.0 * A * B.transpose()), kernels->instruction_set);
        expect_padding(c);
      }
    }
  }
}

TEST(DenseKernels, MultiplyBySparseMatrices) {
  std::mt19937 rng(5);
  for (const DenseKernels* kernels : sets()) {
    for (const int size : kSizes) {
      for (const int inner : {0, 1, 5, 18}) {
        const MatrixXd A = random_matrix(rng, size, inner), C = random_matrix(rng, size, size), a = padded(A);
        MatrixXd B = random_matrix(rng, inner, size);
        B = (B.array().abs() < 0.5).select(B, 0.0).eval();  // columns without entries among them
        const Eigen::SparseMatrix<double> sparse = B.sparseView();
        const SparseColumns columns = {sparse.outerIndexPtr(), sparse.innerIndexPtr(), sparse.valuePtr()};
        MatrixXd c = padded(C);
        kernels->add_lower_sparse_product(size, a.data(), size + 3, columns, c.data(), size + 3);
        expect_near(lower(c.topRows(size)), lower(C + A * B), kernels->instruction_set);
        expect_padding(c);
        c.topRows(size).setConstant(std::nan(""));
        kernels->set_sparse_product(size, size, a.data(), size + 3, columns, c.data(), size + 3);
        expect_near(c.topRows(size), A * B, kernels->instruction_set);
        expect_padding(c);
      }
    }
  }
}

TEST(DenseKernels, FactoriseAndDivide) {
  std::mt19937 rng(3);
  for (const DenseKernels* kernels : sets()) {
    for (const int size : kSizes) {
      const MatrixXd A = random_matrix(rng, size, size);
      MatrixXd lu = padded(A);
      std::vector<int> order(static_cast<std::size_t>(size));
      const double smallest = kernels->factorise_lu(size, lu.data(), size + 3, order.data());
      expect_padding(lu);
      if (size > 0) {
        const Eigen::PartialPivLU<MatrixXd> expected(A);
        EXPECT_NEAR(smallest, expected.matrixLU().diagonal().cwiseAbs().minCoeff(), 1e-12);
        expect_near(lu.topRows(size), expected.matrixLU(), "LU");
        expect_near(A(order, Eigen::all), expected.permutationP() * A, "rows in the order of the pivots");
      }
      const MatrixXd U = lu.topRows(size).triangularView<Eigen::Upper>();
      const MatrixXd L = lu.topRows(size).triangularView<Eigen::UnitLower>();
      for (const int rows : kSizes) {
        const MatrixXd X = random_matrix(rng, rows, size);
        MatrixXd x = padded(X * L.transpose());
        kernels->divide_by_upper(rows, size, lu.data(), size + 3, 1, true, x.data(), rows + 3);
        expect_near(x.topRows(rows), X, "X L' / L'");
        expect_padding(x);
        // Rounding of a division grows with the condition: what comes out is multiplied again.
        x = padded(X);
        kernels->divide_by_lower(rows, size, lu.data(), size + 3, 1, false, x.data(), rows + 3);
        expect_near(x.topRows(rows) * U.transpose(), X, "X / U' U'");
        x = padded(X);
        kernels->divide_by_upper(rows, size, lu.data(), 1, size + 3, false, x.data(), rows + 3);
        expect_near(x.topRows(rows) * U, X, "X / U U");
        expect_padding(x);
      }
    }
  }
}

TEST(DenseKernels, StopAtPivotsThatAreNone) {
  const double nan = std::nan("");
  for (const DenseKernels* kernels : sets()) {
    MatrixXd singular = MatrixXd::Ones(3, 3);
    std::vector<int> order(3);
    EXPECT_EQ(kernels->factorise_lu(3, singular.data(), 3, order.data()), 0.0);
    MatrixXd not_finite = MatrixXd::Identity(3, 3);
    not_finite(1, 1) = nan;
    EXPECT_FALSE(kernels->factorise_lu(3, not_finite.data(), 3, order.data()) > 0.0);
    MatrixXd indefinite = MatrixXd::Identity(3, 3);
    indefinite(2, 1) = 2.0;
    EXPECT_FALSE(kernels->factorise_cholesky(3, indefinite.data(), 3));
    not_finite.setIdentity();
    not_finite(2, 0) = nan;
    EXPECT_FALSE(kernels->factorise_cholesky(3, not_finite.data(), 3));
  }
}

TEST(DenseKernels, FactoriseBySquareRoots) {
  std::mt19937 rng(4);
  for (const DenseKernels* kernels : sets()) {
    for (const int size : kSizes) {
      const MatrixXd root = random_matrix(rng, size, size);
      const MatrixXd A = root * root.transpose() + MatrixXd::Identity(size, size);
      MatrixXd L = padded(A);
      ASSERT_TRUE(kernels->factorise_cholesky(size, L.data(), size + 3));
      expect_padding(L);
      const MatrixXd factor = lower(L.topRows(size));
      expect_near(factor * factor.transpose(), A, kernels->instruction_set);
    }
  }
}

TEST(DenseKernels, FactoriseByReflections) {
  std::mt19937 rng(6);
  for (const DenseKernels* kernels : sets()) {
    for (const int rows : kSizes) {
      for (const int cols : kSizes) {
        for (const int rank : {std::min(rows, cols), std::min({rows, cols, 2})}) {
          const MatrixXd A = random_matrix(rng, rows, rank) * random_matrix(rng, rank, cols);
          MatrixXd qr = padded(A);
          const int steps = std::min(rows, cols);
          std::vector<int> order(static_cast<std::size_t>(cols));
          Eigen::VectorXd tau(steps);
          kernels->factorise_qr(rows, cols, qr.data(), rows + 3, order.data(), tau.data());
          expect_padding(qr);
          const MatrixXd factors = qr.topRows(rows);
          MatrixXd product = factors.triangularView<Eigen::Upper>();
          product.applyOnTheLeft(Eigen::householderSequence(factors, tau).setLength(steps));
          expect_near(product, A(Eigen::all, order), kernels->instruction_set);
          for (int j = 1; j < steps; ++j) {
            EXPECT_LE(std::abs(factors(j, j)), std::abs(factors(j - 1, j - 1)) * (1.0 + 1e-12)) << "not the largest";
          }
          for (int j = rank; j < steps; ++j) EXPECT_LT(std::abs(factors(j, j)), 1e-12 * (1.0 + A.norm()));
        }
      }
    }
  }
}

}  // namespace
}  // namespace prowl

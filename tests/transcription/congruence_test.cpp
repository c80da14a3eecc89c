// Each against A' m A by dense matrices; what is above the diagonal must not matter.
#include "prowl/transcription/congruence.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "tests/support/random_vector.hpp"

namespace prowl {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr Index kSize = 14;

/// `change` must turn a random m into A' m A, where A is the identity but for `block` at (row, col).
template <class Change>
void expect_congruence(std::mt19937& rng, Index row, Index col, const MatrixXd& block, const Change& change) {
  const MatrixXd root = test::random_matrix(rng, kSize, kSize), m = root + root.transpose();
  MatrixXd A = MatrixXd::Identity(kSize, kSize);
  A.block(row, col, block.rows(), block.cols()) = block;
  MatrixXd changed = m;
  changed.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));
  change(changed);
  const MatrixXd symmetric = changed.selfadjointView<Eigen::Lower>();
  EXPECT_LT(test::relative_error(symmetric, A.transpose() * m * A), 1e-14);
}

TEST(Congruence, AddsAMultiple) {
  std::mt19937 rng(1);
  for (const auto& [from, to, count] : {std::array<Index, 3>{0, 4, 4}, {2, 5, 3}, {3, 9, 5}, {1, 3, 0}}) {
    expect_congruence(rng, from, to, 0.7 * MatrixXd::Identity(count, count),
                      [&](MatrixXd& m) { add_multiple(m, from, to, count, 0.7); });
  }
}

TEST(Congruence, AddsAVector) {
  std::mt19937 rng(2);
  for (const auto& [from, to, count] : {std::array<Index, 3>{0, 4, 4}, {2, 13, 3}, {3, 9, 5}, {1, 3, 0}}) {
    const VectorXd x = test::random_vector(rng, count, 1.0);
    expect_congruence(rng, from, to, -0.3 * x, [&](MatrixXd& m) { add_vector(m, from, to, -0.3, x); });
  }
}

TEST(Congruence, AddsABlock) {
  std::mt19937 rng(3);
  for (const auto& [from, to] : {std::pair<Index, Index>{0, 3}, {3, 8}, {0, 11}}) {
    const Matrix3d by = test::random_matrix(rng, 3, 3);
    expect_congruence(rng, from, to, by, [&](MatrixXd& m) { add_block(m, from, to, by); });
  }
}

TEST(Congruence, ReplacesABlock) {
  std::mt19937 rng(4);
  for (const Index at : {0, 3, 11}) {
    const Matrix3d by = test::random_matrix(rng, 3, 3);
    expect_congruence(rng, at, at, by, [&](MatrixXd& m) { replace_block(m, at, by); });
  }
}

}  // namespace
}  // namespace prowl

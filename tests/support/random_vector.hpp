#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <random>

namespace prowl::test {

inline Eigen::VectorXd random_vector(std::mt19937& rng, Eigen::Index size, double size_of_entries) {
  std::uniform_real_distribution<double> uniform(-size_of_entries, size_of_entries);
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return uniform(rng); });
}

inline Eigen::MatrixXd random_matrix(std::mt19937& rng, Eigen::Index rows, Eigen::Index cols,
                                     double size_of_entries = 1.0) {
  return random_vector(rng, rows * cols, size_of_entries).reshaped(rows, cols);
}

/// |actual - expected|, relative to the size of what is expected (the largest entry, at least `floor`).
inline double relative_error(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double floor = 1e-9) {
  if (expected.size() == 0) return 0.0;
  return (actual - expected).cwiseAbs().maxCoeff() / std::max(expected.cwiseAbs().maxCoeff(), floor);
}

}  // namespace prowl::test

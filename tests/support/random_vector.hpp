#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <random>

namespace prowl::test {

inline Eigen::VectorXd random_vector(std::mt19937& rng, Eigen::Index size, double size_of_entries) {
  std::uniform_real_distribution<double> uniform(-size_of_entries, size_of_entries);
  return Eigen::VectorXd::NullaryExpr(size, [&](Eigen::Index) { return uniform(rng); });
}

/// |actual - expected|, relative to the size of what is expected (the largest entry, at least `floor`).
inline double relative_error(const Eigen::MatrixXd& actual, const Eigen::MatrixXd& expected, double floor = 1e-9) {
  if (expected.size() == 0) return 0.0;
  return (actual - expected).cwiseAbs().maxCoeff() / std::max(expected.cwiseAbs().maxCoeff(), floor);
}

}  // namespace prowl::test

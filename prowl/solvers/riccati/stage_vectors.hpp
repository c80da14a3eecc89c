#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

namespace prowl {

/// One vector per stage.
using StageVectors = std::vector<Eigen::VectorXd>;

/// Largest absolute value of all entries; 0 if there is none.
inline double largest(const StageVectors& vectors) {
  double result = 0.0;
  for (const Eigen::VectorXd& v : vectors) {
    if (v.size() > 0) result = std::max(result, v.cwiseAbs().maxCoeff());
  }
  return result;
}

/// Whether all entries are finite: 0 x is 0 unless x is infinite or NaN. A sum uses vectors, unlike allFinite().
inline bool is_finite(const Eigen::MatrixXd& matrix) { return (0.0 * matrix.array()).sum() == 0.0; }

}  // namespace prowl

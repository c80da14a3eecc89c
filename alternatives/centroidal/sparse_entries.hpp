#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// Non-zeros of a matrix in a fixed order without duplicates: first for the pattern, then for
/// values.
struct SparseEntries {
  struct Entry {
    int row, col;
    double value;
  };
  std::vector<Entry> entries;

  template <class Matrix>
  void block(int row, int col, const Eigen::MatrixBase<Matrix>& m) {
    for (Eigen::Index i = 0; i < m.rows(); ++i) {
      for (Eigen::Index j = 0; j < m.cols(); ++j) {
        entries.push_back({row + static_cast<int>(i), col + static_cast<int>(j), m(i, j)});
      }
    }
  }
  void diagonal(int row, int col, int size, double value) {
    for (int i = 0; i < size; ++i) entries.push_back({row + i, col + i, value});
  }
};

}  // namespace prowl

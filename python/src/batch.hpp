#pragma once

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "arrays.hpp"
#include "prowl/error.hpp"

namespace prowl::python {

/// Argument of functions of one or many states: `width` numbers, or N rows of them.
using Argument = nb::ndarray<const double, nb::c_contig, nb::device::cpu>;

/// An argument of checked shape, row by row. Needs no GIL.
class Batch {
 public:
  Batch(const Argument& array, Eigen::Index width, const char* name)
      : single_(array.ndim() == 1),
        rows_(array.ndim() == 2 ? static_cast<Eigen::Index>(array.shape(0)) : 1),
        width_(width),
        data_(array.data()) {
    const bool fits =
        (array.ndim() == 1 || array.ndim() == 2) && static_cast<Eigen::Index>(array.shape(array.ndim() - 1)) == width;
    if (fits) return;
    std::string shape;
    for (std::size_t i = 0; i < array.ndim(); ++i) shape += fmt::format("{}{}", i ? ", " : "", array.shape(i));
    throw InputError(fmt::format("{}: shape ({}) is not allowed; need ({}) or (N, {})", name, shape, width, width));
  }

  bool single() const { return single_; }
  Eigen::Index rows() const { return rows_; }
  Eigen::VectorXd row(Eigen::Index i) const { return Eigen::Map<const Eigen::VectorXd>(data_ + i * width_, width_); }

 private:
  bool single_;
  Eigen::Index rows_, width_;
  const double* data_;
};

/// Throws InputError unless all have as many rows as `first`, and are single if it is.
inline void check_same_rows(const Batch& first, std::initializer_list<std::pair<const char*, const Batch*>> others) {
  for (const auto& [name, other] : others) {
    if (other->rows() == first.rows() && other->single() == first.single()) continue;
    throw InputError(fmt::format("{}: {} rows; need as many as q, {}", name, other->rows(), first.rows()));
  }
}

/// Throws InputError unless all quaternions have unit length.
inline void check_configurations(const Batch& q, const char* name) {
  constexpr double kTolerance = 1e-6;
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const double length = q.row(i).segment<4>(3).norm();
    if (std::abs(length - 1.0) <= kTolerance) continue;
    throw InputError(fmt::format("{}: the quaternion of row {} has length {:.9g}; need 1", name, i, length));
  }
}

/// Results of all rows of a batch: vectors, or matrices row by row.
class Results {
 public:
  Results(const Batch& batch, std::vector<std::size_t> shape) : shape_(std::move(shape)) {
    for (const std::size_t n : shape_) size_ *= n;
    values_.resize(size_ * static_cast<std::size_t>(batch.rows()));
    if (!batch.single()) shape_.insert(shape_.begin(), static_cast<std::size_t>(batch.rows()));
  }

  template <class Derived>
  void set(Eigen::Index i, const Eigen::MatrixBase<Derived>& value) {
    Eigen::Map<RowMatrix>(values_.data() + size_ * static_cast<std::size_t>(i), value.rows(), value.cols()) = value;
  }
  Array array() && { return new_array(std::move(values_), shape_); }

 private:
  std::vector<std::size_t> shape_;
  std::size_t size_ = 1;
  std::vector<double> values_;
};

}  // namespace prowl::python

#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <Eigen/Core>
#include <memory>
#include <vector>

namespace prowl::python {

namespace nb = nanobind;

/// One row per instant: contiguous, like NumPy.
using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

using Vector = nb::ndarray<nb::numpy, const double, nb::ndim<1>>;
using Integers = nb::ndarray<nb::numpy, const int, nb::ndim<1>>;
using Matrix = nb::ndarray<nb::numpy, const double, nb::ndim<2>>;
using Block = nb::ndarray<nb::numpy, const double, nb::ndim<3>>;
using Array = nb::ndarray<nb::numpy, double>;  ///< a new array of any dimension

/// Read-only views of data of `owner`, without copy; a view keeps the owner alive.
inline Vector view(const Eigen::VectorXd& values, nb::handle owner) {
  return {values.data(), {static_cast<std::size_t>(values.size())}, owner};
}
inline Integers view(const Eigen::VectorXi& values, nb::handle owner) {
  return {values.data(), {static_cast<std::size_t>(values.size())}, owner};
}
inline Matrix view(const RowMatrix& rows, nb::handle owner) {
  return {rows.data(), {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols())}, owner};
}
/// View with columns as rows; column-major in memory.
inline Matrix transposed_view(const Eigen::MatrixXd& columns, nb::handle owner) {
  return {columns.data(), {static_cast<std::size_t>(columns.cols()), static_cast<std::size_t>(columns.rows())}, owner};
}
/// Rows of three numbers per contact as instants x contacts x 3.
inline Block contacts_view(const RowMatrix& rows, nb::handle owner) {
  return {rows.data(), {static_cast<std::size_t>(rows.rows()), static_cast<std::size_t>(rows.cols()) / 3, 3}, owner};
}

/// One vector of every point, as rows.
template <class Point>
RowMatrix rows_of(const std::vector<Point>& points, Eigen::VectorXd Point::* vector) {
  if (points.empty()) return {};
  RowMatrix rows(static_cast<Eigen::Index>(points.size()), (points.front().*vector).size());
  for (std::size_t k = 0; k < points.size(); ++k)
    rows.row(static_cast<Eigen::Index>(k)) = (points[k].*vector).transpose();
  return rows;
}

/// A new array that owns its numbers.
inline Array new_array(std::vector<double> values, const std::vector<std::size_t>& shape) {
  auto kept = std::make_unique<std::vector<double>>(std::move(values));
  const nb::capsule owner(kept.get(), [](void* memory) noexcept { delete static_cast<std::vector<double>*>(memory); });
  double* const data = kept.release()->data();
  return {data, shape.size(), shape.data(), owner};
}
inline Array new_array(const Eigen::VectorXd& values) {
  return new_array({values.begin(), values.end()}, {static_cast<std::size_t>(values.size())});
}

}  // namespace prowl::python

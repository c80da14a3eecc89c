#pragma once

#include <Eigen/Core>

#include "prowl/kernels/dense_kernels.hpp"

namespace prowl {

/// The products of dense_kernels() for Eigen's matrices and their blocks. All are stored by columns, but B in `set` and
/// `add` may be a transpose. Sizes must agree, C included. C must not overlap A or B.
class MatrixProducts {
 public:
  /// C = factor A B
  template <class A, class B, class C>
  void set(C&& c, const A& a, const B& b, double factor = 1.0) const {
    kernels_.set_product(size(a.rows()), size(b.cols()), size(a.cols()), factor, a.data(), size(a.colStride()),
                         b.data(), size(b.rowStride()), size(b.colStride()), c.data(), size(c.colStride()));
  }
  /// C += factor A B
  template <class A, class B, class C>
  void add(C&& c, const A& a, const B& b, double factor = 1.0) const {
    kernels_.add_product(size(a.rows()), size(b.cols()), size(a.cols()), factor, a.data(), size(a.colStride()),
                         b.data(), size(b.rowStride()), size(b.colStride()), c.data(), size(c.colStride()));
  }
  /// C = factor A B' in the lower triangle; above it C is undefined afterwards.
  template <class A, class B, class C>
  void set_lower(C&& c, const A& a, const B& b, double factor = 1.0) const {
    kernels_.set_lower_product(size(a.rows()), size(a.cols()), factor, a.data(), size(a.colStride()), b.data(),
                               size(b.colStride()), c.data(), size(c.colStride()));
  }
  /// C += factor A B' in the lower triangle; above it C is undefined afterwards.
  template <class A, class B, class C>
  void add_lower(C&& c, const A& a, const B& b, double factor = 1.0) const {
    kernels_.add_lower_product(size(a.rows()), size(a.cols()), factor, a.data(), size(a.colStride()), b.data(),
                               size(b.colStride()), c.data(), size(c.colStride()));
  }

 private:
  static int size(Eigen::Index value) { return static_cast<int>(value); }

  const DenseKernels& kernels_ = dense_kernels();
};

}  // namespace prowl

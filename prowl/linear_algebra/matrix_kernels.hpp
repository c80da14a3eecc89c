#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <vector>

#include "prowl/kernels/dense_kernels.hpp"

namespace prowl {

/// dense_kernels() for Eigen's matrices and their blocks, stored by columns; B in `set` and `add`, and T, may be
/// transposes. Results must not overlap operands. Sizes must agree; a build without NDEBUG checks them.
class MatrixKernels {
 public:
  /// C = factor A B
  template <class A, class B, class C>
  void set(C&& c, const A& a, const B& b, double factor = 1.0) const {
    check(c.rows() == a.rows() && c.cols() == b.cols() && a.cols() == b.rows());
    kernels_.set_product(size(a.rows()), size(b.cols()), size(a.cols()), factor, a.data(), stride(a), b.data(),
                         size(b.rowStride()), stride(b), c.data(), stride(c));
  }
  /// C += factor A B
  template <class A, class B, class C>
  void add(C&& c, const A& a, const B& b, double factor = 1.0) const {
    check(c.rows() == a.rows() && c.cols() == b.cols() && a.cols() == b.rows());
    kernels_.add_product(size(a.rows()), size(b.cols()), size(a.cols()), factor, a.data(), stride(a), b.data(),
                         size(b.rowStride()), stride(b), c.data(), stride(c));
  }
  /// C = factor A B' in the lower triangle; above it C is undefined afterwards.
  template <class A, class B, class C>
  void set_lower(C&& c, const A& a, const B& b, double factor = 1.0) const {
    check(c.rows() == a.rows() && c.cols() == b.rows() && a.rows() == b.rows() && a.cols() == b.cols());
    kernels_.set_lower_product(size(a.rows()), size(a.cols()), factor, a.data(), stride(a), b.data(), stride(b),
                               c.data(), stride(c));
  }
  /// C += factor A B' in the lower triangle; above it C is undefined afterwards.
  template <class A, class B, class C>
  void add_lower(C&& c, const A& a, const B& b, double factor = 1.0) const {
    check(c.rows() == a.rows() && c.cols() == b.rows() && a.rows() == b.rows() && a.cols() == b.cols());
    kernels_.add_lower_product(size(a.rows()), size(a.cols()), factor, a.data(), stride(a), b.data(), stride(b),
                               c.data(), stride(c));
  }
  /// C = A B for a compressed sparse B.
  template <class A, class Sparse, class C>
  void set_sparse(C&& c, const A& a, const Sparse& b) const {
    check(c.rows() == a.rows() && c.cols() == b.cols() && a.cols() == b.rows());
    kernels_.set_sparse_product(size(a.rows()), size(b.cols()), a.data(), stride(a), columns(b), c.data(), stride(c));
  }
  /// C += A B in the lower triangle, for a compressed sparse B; above it C is undefined afterwards.
  template <class A, class Sparse, class C>
  void add_lower_sparse(C&& c, const A& a, const Sparse& b) const {
    check(c.rows() == a.rows() && c.cols() == a.rows() && a.cols() == b.rows() && b.cols() == c.cols());
    kernels_.add_lower_sparse_product(size(a.rows()), a.data(), stride(a), columns(b), c.data(), stride(c));
  }

  /// As in DenseKernels, in place of A. `order` gets the size that it needs; `tau` has it.
  double factorise_lu(Eigen::MatrixXd& a, std::vector<int>& order) const {
    order.resize(static_cast<std::size_t>(a.rows()));
    return kernels_.factorise_lu(size(a.rows()), a.data(), stride(a), order.data());
  }
  bool factorise_cholesky(Eigen::MatrixXd& a) const {
    return kernels_.factorise_cholesky(size(a.rows()), a.data(), stride(a));
  }
  void factorise_qr(Eigen::MatrixXd& a, std::vector<int>& order, Eigen::VectorXd& tau) const {
    order.resize(static_cast<std::size_t>(a.cols()));
    tau.resize(std::min(a.rows(), a.cols()));
    kernels_.factorise_qr(size(a.rows()), size(a.cols()), a.data(), stride(a), order.data(), tau.data());
  }

  enum class Diagonal { read, ones };
  /// X := X T^-1 for a triangular T, the first rows and columns of `t`; the rest of it is not read.
  template <class T>
  void divide_by_upper(Eigen::MatrixXd& x, const T& t, Diagonal diagonal = Diagonal::read) const {
    kernels_.divide_by_upper(size(x.rows()), size(x.cols()), t.data(), size(t.rowStride()), stride(t),
                             diagonal == Diagonal::ones, x.data(), stride(x));
  }
  template <class T>
  void divide_by_lower(Eigen::MatrixXd& x, const T& t, Diagonal diagonal = Diagonal::read) const {
    kernels_.divide_by_lower(size(x.rows()), size(x.cols()), t.data(), size(t.rowStride()), stride(t),
                             diagonal == Diagonal::ones, x.data(), stride(x));
  }

 private:
  static int size(Eigen::Index value) { return static_cast<int>(value); }
  template <class Matrix>
  static int stride(const Matrix& matrix) {
    return size(matrix.colStride());
  }
  template <class Sparse>
  static SparseColumns columns(const Sparse& b) {
    return {b.outerIndexPtr(), b.innerIndexPtr(), b.valuePtr()};
  }
  static void check([[maybe_unused]] bool sizes_agree) { eigen_assert(sizes_agree); }

  const DenseKernels& kernels_ = dense_kernels();
};

}  // namespace prowl

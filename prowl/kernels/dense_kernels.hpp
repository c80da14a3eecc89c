#pragma once

namespace prowl {

/// A sparse matrix: column j has the entries starts[j] to starts[j + 1] - 1, each with its row and its value.
struct SparseColumns {
  const int *starts, *rows;
  const double* values;
};

/// Products and factorisations of small dense matrices (about 10 to 100 rows), compiled for several instruction sets.
/// Plain arrays, stored by columns; `ld...`: distance of two columns. No Eigen type: its inline functions, compiled for
/// one instruction set, must not serve code that was compiled for another. No allocation, no alignment, no exceptions;
/// sizes may be 0. Output must not overlap input.
struct DenseKernels {
  const char* instruction_set;  ///< "x86-64", "x86-64-v3"

  /// C (rows x cols) = factor A B or C += factor A B, with A (rows x inner) and B (inner x cols),
  /// B(i, j) = b[i * b_row + j * b_col]. Only the second reads C.
  void (*set_product)(int rows, int cols, int inner, double factor, const double* a, int lda, const double* b,
                      int b_row, int b_col, double* c, int ldc);
  void (*add_product)(int rows, int cols, int inner, double factor, const double* a, int lda, const double* b,
                      int b_row, int b_col, double* c, int ldc);

  /// The same for the lower triangle of C (size x size) and A B', A and B (size x inner). Above the diagonal C is
  /// undefined afterwards.
  void (*set_lower_product)(int size, int inner, double factor, const double* a, int lda, const double* b, int ldb,
                            double* c, int ldc);
  void (*add_lower_product)(int size, int inner, double factor, const double* a, int lda, const double* b, int ldb,
                            double* c, int ldc);

  /// C (rows x cols) = A B for a sparse B.
  void (*set_sparse_product)(int rows, int cols, const double* a, int lda, const SparseColumns& b, double* c, int ldc);
  /// Lower triangle of C (size x size) += A B for a sparse B.
  void (*add_lower_sparse_product)(int size, const double* a, int lda, const SparseColumns& b, double* c, int ldc);

  /// LU with row pivoting: row i of L U is row order[i] of A (size x size), which they replace. Returns the smallest
  /// pivot's absolute value, at which it stops if that is 0 or not a number.
  double (*factorise_lu)(int size, double* a, int lda, int* order);

  /// Cholesky: the lower triangle of A (size x size) becomes L, A = L L'. Returns false at a pivot that is not
  /// positive.
  bool (*factorise_cholesky)(int size, double* a, int lda);

  /// QR with column pivoting: column j of Q R is column order[j] of A (rows x cols), which R replaces on and above its
  /// diagonal. Below it are the vectors v_j of Q = H_0 H_1 ..., H_j = I - tau[j] v_j v_j', v_j = (0 ... 0, 1, those).
  /// tau: as many as the smaller of rows and cols.
  void (*factorise_qr)(int rows, int cols, double* a, int lda, int* order, double* tau);

  /// X (rows x size) := X T^-1 for an upper triangular T, T(i, j) = t[i * t_row + j * t_col]; `unit`: with ones on its
  /// diagonal, which is not read.
  void (*divide_by_upper)(int rows, int size, const double* t, int t_row, int t_col, bool unit, double* x, int ldx);
  void (*divide_by_lower)(int rows, int size, const double* t, int t_row, int t_col, bool unit, double* x, int ldx);
};

/// The fastest that this processor runs and GLIBC_TUNABLES allows.
const DenseKernels& dense_kernels();

extern const DenseKernels kernels_x86_64;     ///< any processor
extern const DenseKernels kernels_x86_64_v3;  ///< needs AVX2 and FMA

}  // namespace prowl

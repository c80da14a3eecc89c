#pragma once

#include <Eigen/Core>

namespace prowl {

/// Congruences m -> A' m A of a symmetric matrix, in place: what becomes of a Hessian when some variables are replaced
/// by functions of others. A is the identity but for one block. Of m the lower triangle counts; above it m
/// is undefined afterwards. `from` precedes `to`, and their blocks do not overlap. No heap allocation.

/// A(from + i, to + i) = factor, i < count
void add_multiple(Eigen::MatrixXd& m, Eigen::Index from, Eigen::Index to, Eigen::Index count, double factor);
/// A(from + i, to) = factor * x(i)
void add_vector(Eigen::MatrixXd& m, Eigen::Index from, Eigen::Index to, double factor,
                const Eigen::Ref<const Eigen::VectorXd>& x);
/// A(from + i, to + j) = by(i, j)
void add_block(Eigen::MatrixXd& m, Eigen::Index from, Eigen::Index to, const Eigen::Matrix3d& by);
/// A(at + i, at + j) = by(i, j)
void replace_block(Eigen::MatrixXd& m, Eigen::Index at, const Eigen::Matrix3d& by);

}  // namespace prowl

#include "prowl/dynamics/projector.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/linear_algebra/matrix_kernels.hpp"

namespace prowl {

void Projector::compute(const Eigen::MatrixXd& J, double rank_threshold) {
  if (!J.allFinite()) throw NumericalError("the contact Jacobian is not finite: a configuration is NaN or too large");
  const Eigen::Index rows = J.rows();
  qr_ = J.transpose();
  MatrixKernels().factorise_qr(qr_, order_, tau_);
  find_rank(rank_threshold);
  if (rank_ < rows) {
    factor_deficient();
    gram_inverse_.noalias() = inverse_factor_.transpose() * inverse_factor_;
  } else if (rows > 0) {
    factor_full();
  } else {
    inverse_factor_.resize(0, 0);
    gram_inverse_.resize(0, 0);
  }
}

// J' Π = V R, that is J = Π R' V': U = Π, T = R', (J J')⁻¹ = Π R⁻¹ R'⁻¹ Π'.
void Projector::factor_full() {
  const Eigen::Index rows = qr_.cols();
  inverse_factor_.resize(rows, rows);
  permuted_gram_.resize(rows, rows);
  gram_inverse_.resize(rows, rows);
  upper_inverse_.setIdentity(rows, rows);
  MatrixKernels().divide_by_upper(upper_inverse_, qr_);
  MatrixKernels().set_lower(permuted_gram_, upper_inverse_, upper_inverse_);
  for (Eigen::Index i = 0; i < rows; ++i) {
    inverse_factor_.col(order_[i]) = upper_inverse_.row(i).transpose();
    for (Eigen::Index j = 0; j <= i; ++j) {
      gram_inverse_(order_[i], order_[j]) = gram_inverse_(order_[j], order_[i]) = permuted_gram_(i, j);
    }
  }
}

// Why 1e-8: entries of J are lengths in metres and direction cosines, correct to about 1e-15. Dependent rows leave
// pivots of at most 1e-14; two points d metres apart on one link leave a pivot of about d. The threshold thus separates
// redundant contacts from all others. It is also the square root of the rounding: below it (J J')⁺, and with it the
// forces, have no correct digit.
void Projector::find_rank(double threshold) {
  rank_ = 0;
  pivot_ratio_ = 1.0;
  if (qr_.cols() == 0) return;
  const auto pivots = qr_.diagonal();
  if (pivots(0) == 0.0) return;
  for (Eigen::Index i = 0; i < pivots.size(); ++i) {
    const double ratio = std::abs(pivots(i) / pivots(0));
    if (ratio <= threshold) continue;
    pivot_ratio_ = ratio;
    ++rank_;
  }
}

// Complete orthogonal decomposition: J' Π = V [R1 R2], a trapezoid; its transpose is W T, so that J = Π W T V', U = Π
// W.
void Projector::factor_deficient() {
  if (rank_ == 0) {
    inverse_factor_.setZero(0, qr_.cols());
    return;
  }
  trapezoid_.setZero(qr_.cols(), rank_);
  trapezoid_.transpose().triangularView<Eigen::Upper>() = qr_.topRows(rank_);
  trapezoid_qr_.compute(trapezoid_);
  Eigen::MatrixXd& U = trapezoid_;
  U.setIdentity();
  trapezoid_qr_.householderQ().applyThisOnTheLeft(U, reflected_);
  inverse_factor_.resize(rank_, qr_.cols());
  for (Eigen::Index i = 0; i < qr_.cols(); ++i) inverse_factor_.col(order_[i]) = U.row(i).transpose();
  trapezoid_qr_.matrixQR().topRows(rank_).triangularView<Eigen::Upper>().solveInPlace(inverse_factor_);
}

void Projector::set_row_space(Eigen::MatrixXd& V, Eigen::RowVectorXd& work_space) const {
  V.setIdentity(qr_.rows(), rank_);
  if (rank_ > 0) Eigen::householderSequence(qr_, tau_).setLength(rank_).applyThisOnTheLeft(V, work_space);
}

Eigen::MatrixXd Projector::row_space() const {
  Eigen::MatrixXd V;
  Eigen::RowVectorXd work_space;
  set_row_space(V, work_space);
  return V;
}

void Projector::form(Eigen::MatrixXd& matrix, Eigen::MatrixXd& pseudo_inverse) {
  set_row_space(row_space_, reflected_);
  matrix.setIdentity(qr_.rows(), qr_.rows());
  matrix.noalias() -= row_space_ * row_space_.transpose();
  pseudo_inverse.resize(qr_.rows(), qr_.cols());
  pseudo_inverse.noalias() = row_space_ * inverse_factor_;
}

Eigen::MatrixXd Projector::pseudo_inverse() const { return row_space() * inverse_factor_; }

Eigen::MatrixXd Projector::matrix() const {
  const Eigen::MatrixXd V = row_space();
  return Eigen::MatrixXd::Identity(V.rows(), V.rows()) - V * V.transpose();
}

}  // namespace prowl

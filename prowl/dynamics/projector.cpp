#include "prowl/dynamics/projector.hpp"

#include <cmath>

#include "prowl/error.hpp"

namespace prowl {

void Projector::compute(const Eigen::MatrixXd& J) {
  if (!J.allFinite()) throw NumericalError("the contact Jacobian is not finite: a configuration is NaN or too large");
  const Eigen::Index rows = J.rows();
  transposed_ = J.transpose();
  if (rows > 0) qr_.compute(transposed_);
  find_rank();
  if (rank_ < rows) {
    factor_deficient();
  } else if (rows > 0) {  // J' Π = V R, that is J = Π R' V': U = Π, T = R'
    inverse_factor_ = qr_.colsPermutation().transpose();
    qr_.matrixQR().topRows(rows).triangularView<Eigen::Upper>().transpose().solveInPlace(inverse_factor_);
  }
  if (rank_ == 0) inverse_factor_.setZero(0, rows);
  gram_inverse_.noalias() = inverse_factor_.transpose() * inverse_factor_;
}

// Why 1e-8. Entries of J are lengths in metres and direction cosines, right to about 1e-15: rows that depend on each
// other leave pivots of 1e-14 or less, and two points d metres apart on one link leave a pivot of about d. So the
// threshold parts redundant contacts from all that a robot can have. And it is the square root of the rounding:
// (J J')⁺, and with it the forces, would have no correct digit below it.
void Projector::find_rank() {
  rank_ = 0;
  pivot_ratio_ = 1.0;
  rank_is_ambiguous_ = false;
  if (transposed_.cols() == 0) return;
  const auto pivots = qr_.matrixQR().diagonal();
  if (pivots(0) == 0.0) return;
  for (Eigen::Index i = 0; i < pivots.size(); ++i) {
    const double ratio = std::abs(pivots(i) / pivots(0));
    rank_is_ambiguous_ |= ratio > kAmbiguousAbove && ratio < kAmbiguousBelow;
    if (ratio <= kRankThreshold) continue;
    pivot_ratio_ = ratio;
    ++rank_;
  }
}

// Complete orthogonal decomposition: J' Π = V [R1 R2], a trapezoid; its transpose is W T, so that J = Π W T V', U = Π W.
void Projector::factor_deficient() {
  Eigen::MatrixXd trapezoid = Eigen::MatrixXd::Zero(qr_.cols(), rank_);
  trapezoid.transpose().triangularView<Eigen::Upper>() = qr_.matrixQR().topRows(rank_);
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(trapezoid);
  Eigen::MatrixXd U = Eigen::MatrixXd::Identity(qr_.cols(), rank_);
  U.applyOnTheLeft(qr.householderQ());
  U.applyOnTheLeft(qr_.colsPermutation());
  inverse_factor_ = U.transpose();
  qr.matrixQR().topRows(rank_).triangularView<Eigen::Upper>().solveInPlace(inverse_factor_);
}

Eigen::MatrixXd Projector::row_space() const {
  Eigen::MatrixXd V = Eigen::MatrixXd::Identity(transposed_.rows(), rank_);
  if (rank_ > 0) V.applyOnTheLeft(qr_.householderQ().setLength(rank_));
  return V;
}

Eigen::MatrixXd Projector::pseudo_inverse() const { return row_space() * inverse_factor_; }

Eigen::MatrixXd Projector::matrix() const {
  const Eigen::MatrixXd V = row_space();
  return Eigen::MatrixXd::Identity(V.rows(), V.rows()) - V * V.transpose();
}

}  // namespace prowl

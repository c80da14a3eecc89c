#pragma once

#include <Eigen/Core>
#include <Eigen/QR>

namespace prowl {

/// The projector on the motions that the contacts allow, P = I − J⁺J, by a rank-revealing factorisation of the
/// contact Jacobian J (m × n):
///
///   J = U T V',   U (m × rank), V (n × rank) with orthonormal columns, T triangular and regular
///
///   P = I − V V',   J⁺ = V T⁻¹ U',   (J J')⁺ = (T⁻¹ U')' (T⁻¹ U')
///
/// Rows may depend on each other (flat feet, contacts listed twice) and may be missing (m = 0: P = I). docs/theory.md.
/// compute() finds the rank and (J J')⁺, all that the inverse form needs, and does not allocate unless the shape of J
/// changes or J is rank deficient; V, J⁺ and P are formed when asked for.
class Projector {
 public:
  /// Pivots below this part of the largest count as zero. See projector.cpp for why.
  static constexpr double kRankThreshold = 1e-8;

  /// Throws NumericalError if J is not finite. A larger threshold is for configurations that are a little off their
  /// contacts, where rows that depend on each other do so but for that distance [m].
  void compute(const Eigen::MatrixXd& J, double rank_threshold = kRankThreshold);

  int rank() const { return rank_; }
  bool full_rank() const { return rank_ == gram_inverse_.cols(); }
  /// Smallest pivot that counts over the largest, in (0, 1]; 1 where there is none. It follows the ratio of the
  /// singular values of J within a small factor, for a fraction of the time.
  double pivot_ratio() const { return pivot_ratio_; }

  const Eigen::MatrixXd& gram_inverse() const { return gram_inverse_; }  ///< (J J')⁺, m × m
  Eigen::MatrixXd row_space() const;                                     ///< V, n × rank
  Eigen::MatrixXd pseudo_inverse() const;                                ///< J⁺, n × m
  Eigen::MatrixXd matrix() const;                                        ///< P, n × n

 private:
  void find_rank(double threshold);
  void factor_full();
  void factor_deficient();

  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr_;  // of J'
  Eigen::MatrixXd transposed_, gram_inverse_;
  Eigen::MatrixXd inverse_factor_;  // T⁻¹ U', rank × m
  Eigen::MatrixXd upper_inverse_, permuted_gram_;
  int rank_ = 0;
  double pivot_ratio_ = 1.0;
};

}  // namespace prowl

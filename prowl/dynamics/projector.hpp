#pragma once

#include <Eigen/Core>
#include <Eigen/QR>
#include <vector>

namespace prowl {

/// The projector on the motions that the contacts allow, P = I − J⁺J, by a rank-revealing factorisation of the
/// contact Jacobian J (m × n):
///
///   J = U T V',   U (m × rank), V (n × rank) with orthonormal columns, T triangular and regular
///
///   P = I − V V',   J⁺ = V T⁻¹ U',   (J J')⁺ = (T⁻¹ U')' (T⁻¹ U')
///
/// Rows may be dependent (flat feet, contacts listed twice) or absent (m = 0: P = I). See docs/theory.md. compute()
/// finds the rank and (J J')⁺, enough for the inverse form; V, J⁺ and P are formed on request. It allocates only if the
/// shape of J or its rank changes, like the functions with a result to write to.
class Projector {
 public:
  /// Pivots below this part of the largest count as zero; projector.cpp explains it.
  static constexpr double kRankThreshold = 1e-8;

  /// Throws NumericalError if J is not finite. A larger threshold [m] suits configurations up to that far off their
  /// contacts.
  void compute(const Eigen::MatrixXd& J, double rank_threshold = kRankThreshold);

  int rank() const { return rank_; }
  bool full_rank() const { return rank_ == gram_inverse_.cols(); }
  /// Smallest counted pivot over the largest, in (0, 1]; 1 if there is none. It estimates the ratio of the singular
  /// values of J within a small factor, in a fraction of the time.
  double pivot_ratio() const { return pivot_ratio_; }

  const Eigen::MatrixXd& gram_inverse() const { return gram_inverse_; }  ///< (J J')⁺, m × m
  Eigen::MatrixXd row_space() const;                                     ///< V, n × rank
  Eigen::MatrixXd pseudo_inverse() const;                                ///< J⁺, n × m
  Eigen::MatrixXd matrix() const;                                        ///< P, n × n
  void form(Eigen::MatrixXd& matrix, Eigen::MatrixXd& pseudo_inverse);   ///< P and J⁺

 private:
  void find_rank(double threshold);
  void factor_full();
  void factor_deficient();
  void set_row_space(Eigen::MatrixXd& V, Eigen::RowVectorXd& work_space) const;

  Eigen::MatrixXd qr_;      // of J', n × m, by DenseKernels::factorise_qr
  Eigen::VectorXd tau_;     // its reflections
  std::vector<int> order_;  // its columns
  Eigen::MatrixXd gram_inverse_;
  Eigen::MatrixXd inverse_factor_;  // T⁻¹ U', rank × m
  Eigen::MatrixXd upper_inverse_, permuted_gram_;
  Eigen::MatrixXd trapezoid_, row_space_;  // work space
  Eigen::HouseholderQR<Eigen::MatrixXd> trapezoid_qr_;
  Eigen::RowVectorXd reflected_;
  int rank_ = 0;
  double pivot_ratio_ = 1.0;
};

}  // namespace prowl

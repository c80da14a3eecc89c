#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// Slacks s of all inequalities of a program, lower <= s <= upper, with the barrier
///
///   - mu (sum of log(s - lower) + sum of log(upper - s))
///
/// multipliers z >= 0 of the finite bounds, and lambda of inequality - s = 0.
class Slacks {
 public:
  Slacks(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

  Eigen::Index size() const { return s.size(); }
  int num_bounds() const { return static_cast<int>(below_.size() + above_.size()); }

  /// s = values of the inequalities, at least push min(max(1, |bound|), upper - lower) inside.
  void initialise(const Eigen::VectorXd& values, double push);
  /// z = mu / distance.
  void center(double mu);
  /// Starts from the multipliers of a neighbouring problem: z from lambda, but at least mu /
  /// distance; slacks keep a distance of mu / z.
  void initialise(const Eigen::VectorXd& values, const Eigen::VectorXd& lambda, double mu, double push);

  double log_barrier() const;  ///< without mu
  /// beta = derivative of mu log_barrier in s, the target of lambda.
  void pull(double mu, Eigen::VectorXd& beta) const;
  void weights(Eigen::VectorXd& sigma) const;  ///< sum of z / distance

  /// Steps of z for a step of s, towards complementarity mu.
  void set_step(double mu, const Eigen::VectorXd& ds);
  /// Largest fraction of the step, at most 1, that keeps each distance (primal) or z (dual) at 1 -
  /// tau of its value or more.
  double longest_primal(double tau, const Eigen::VectorXd& ds) const;
  double longest_dual(double tau) const;
  /// s = from + alpha ds. False if this reaches a bound.
  bool move(const Eigen::VectorXd& from, double alpha, const Eigen::VectorXd& ds);
  /// s = value of the inequality where the fraction-to-the-boundary rule from `from` allows it and
  /// the change exceeds rounding: near a bound, with s = mu / z, rounding would spoil mu / s.
  void reset(const Eigen::VectorXd& from, const Eigen::VectorXd& values, double tau);
  /// z += alpha dz, then clamped to mu / distance within the factor `spread`.
  void move_dual(double alpha, double mu, double spread);

  double largest_complementarity(double mu) const;                     ///< |z distance - mu|
  double largest_dual_violation(const Eigen::VectorXd& lambda) const;  ///< |- lambda - z_lower + z_upper|
  double sum_of_multipliers() const;

  Eigen::VectorXd s;

 private:
  struct Bound {
    Eigen::Index row = 0;
    double at = 0.0;
    double z = 0.0, dz = 0.0;
  };
  double distance_below(const Bound& b) const { return s(b.row) - b.at; }
  double distance_above(const Bound& b) const { return b.at - s(b.row); }
  template <class Self, class Visit>
  static void for_each(Self& self, Visit visit);

  Eigen::VectorXd lower_, upper_;
  std::vector<Bound> below_, above_;
  std::vector<bool> outside_;
};

}  // namespace prowl

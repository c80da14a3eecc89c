#pragma once

#include <Eigen/Core>
#include <vector>

namespace prowl {

/// Slacks s of all inequalities of a program, lower <= s <= upper, as a barrier method sees them:
///
///   barrier  - mu (sum of log(s - lower) + sum of log(upper - s))
///
/// with multipliers z >= 0 of the bounds that are finite, and lambda of inequality - s = 0.
class Slacks {
 public:
  Slacks(const Eigen::VectorXd& lower, const Eigen::VectorXd& upper);

  Eigen::Index size() const { return s.size(); }
  int num_bounds() const { return static_cast<int>(below_.size() + above_.size()); }

  /// s at the values of the inequalities, but inside the bounds by `push` and by that part of their distance.
  void start(const Eigen::VectorXd& values, double push);
  /// z = mu / distance.
  void center(double mu);
  /// Starts from multipliers of a neighbouring problem: z is what they say, but at least mu / distance, and slacks keep
  /// a distance of mu / z.
  void start(const Eigen::VectorXd& values, const Eigen::VectorXd& lambda, double mu, double push);

  double log_barrier() const;  ///< without mu
  /// beta = derivative of mu log_barrier in s: lambda is to become that.
  void pull(double mu, Eigen::VectorXd& beta) const;
  void weights(Eigen::VectorXd& sigma) const;  ///< sum of z / distance

  /// Steps of z for a step of s, to the barrier's mu.
  void set_step(double mu, const Eigen::VectorXd& ds);
  /// Longest part of the step that leaves each distance, or each z, at least 1 - tau of what it is; at most 1.
  double longest_primal(double tau, const Eigen::VectorXd& ds) const;
  double longest_dual(double tau) const;
  /// s = from + alpha ds. False if that is on a bound or beyond.
  bool move(const Eigen::VectorXd& from, double alpha, const Eigen::VectorXd& ds);
  /// s = value of the inequality where that is as far inside as the fraction to the boundary allows, seen from `from`,
  /// and differs by more than rounding: near a bound, where s is mu / z, rounding would turn mu / s about.
  void reset(const Eigen::VectorXd& from, const Eigen::VectorXd& values, double tau);
  /// z += alpha dz, and then as near to mu / distance as `spread` allows.
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

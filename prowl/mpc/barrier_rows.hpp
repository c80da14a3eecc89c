#pragma once

#include <Eigen/Core>
#include <limits>

namespace prowl {

/// Inequalities lower <= r <= upper of one stage in a primal-dual interior-point method. Each finite bound has a
/// distance d > 0, a multiplier z > 0, and, if it may give way, an elastic variable t > 0 at the price of `penalty` a
/// unit: an exact penalty, which is 0 where the bound can be kept. On the central path of a barrier parameter mu:
///
///   sign (r - bound) = d - t,   z d = mu,   (penalty - z) t = mu
///
/// These equations need not hold at first: a measured state may violate bounds. A step that a bound would stop may be
/// taken in full: that bound's distance then differs from its row until later steps.
class BarrierRows {
 public:
  static constexpr double kHard = std::numeric_limits<double>::infinity();

  explicit BarrierRows(Eigen::Index rows);

  Eigen::Index size() const { return lower_.at.size(); }
  /// A bound that was infinite before starts on the central path at the next linearisation.
  void set_bounds(Eigen::Index row, double lower, double upper, double penalty);
  const Eigen::VectorXd& lower() const { return lower_.at; }
  const Eigen::VectorXd& upper() const { return upper_.at; }
  const Eigen::VectorXd& penalty() const { return penalty_; }
  /// Lets all bounds start like that.
  void reset();
  /// Copies bounds, distances, multipliers and elastic variables from a neighbouring stage; multipliers times `factor`.
  void copy(const BarrierRows& from, double factor);

  /// Leaves room for a new set of active bounds: distances of at least `distance`, and multipliers that neither vanish
  /// nor exhaust their penalty, as on the path of mu.
  void open(const Eigen::VectorXd& values, double mu, double distance);

  /// Newton's equations at these values of the rows: their weights in the Hessian. `mu`: of bounds that start.
  void linearise(const Eigen::VectorXd& values, double mu, Eigen::VectorXd& weights);
  /// After linearise(): pull of each row, the derivative of the Lagrangian in r, for a step to the path of mu.
  void aim(double mu, Eigen::VectorXd& pull);
  /// After aim() or correct(): the steps of all bounds that go with this step of the rows.
  void find_steps(const Eigen::VectorXd& change);
  /// After aim(0) and find_steps(): the pull with the products of second order of these steps, as in Mehrotra 1992.
  void correct(double mu, Eigen::VectorXd& pull);
  /// After find_steps(): takes this share of them; of the multipliers as much as each allows. Returns how far distances
  /// then are from the rows, at most [units of rows].
  double step(double share = 1.0);
  /// The share of the steps, at most 1, that keeps all distances and elastic variables positive.
  double longest() const;
  /// Sum of z d and (penalty - z) t after this share of the steps, and the number of these products.
  double products(double share) const;
  int num_products() const;
  /// Multipliers of the rows in the Lagrangian: negative at lower bounds.
  void multipliers(Eigen::VectorXd& result) const;

 private:
  struct Side {
    double sign = 1.0;
    Eigen::VectorXd at, d, z, t;
    Eigen::VectorXd zd, yt;                  ///< products z d and (penalty - z) t that the step aims at
    Eigen::VectorXd target, compliance;      ///< dz = (target - sign change) / compliance
    Eigen::VectorXd gap;                     ///< of the latest linearise()
    Eigen::VectorXd d_step, z_step, t_step;  ///< of the latest find_steps()
  };
  bool is_bound(const Side& side, Eigen::Index row) const { return std::abs(side.at(row)) < kHard; }
  /// each(side, row) for all finite bounds of these `rows`, lower ones first.
  template <class Rows, class Each>
  static void for_each_bound(Rows& rows, const Each& each);
  bool is_soft(Eigen::Index row) const { return penalty_(row) < kHard; }
  /// How far the bound gives way; a hard one does not.
  double elastic(const Side& side, Eigen::Index row) const { return is_soft(row) ? side.t(row) : 0.0; }
  void set_target(Side& side, Eigen::Index row, Eigen::VectorXd& pull);
  void center(Side& side, Eigen::Index row, double value, double mu);
  double gap(const Side& side, Eigen::Index row, double value) const { return side.sign * (value - side.at(row)); }

  Side lower_, upper_;
  Eigen::VectorXd penalty_, change_;
  double mu_ = 0.0;  ///< that the step aims at
};

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <unsupported/Eigen/Splines>
#include <utility>
#include <vector>

namespace prowl {

/// A limit as a function of one number, e.g. the torque of a joint over its position: the cubic B-spline through the
/// points of a table, twice continuously differentiable; beyond the table its tangent at the end.
class LimitCurve {
 public:
  using Table = std::vector<std::pair<double, double>>;  ///< (x, limit), x increasing

  static constexpr std::size_t kFewestPoints = 4;  ///< that a cubic needs

  /// Throws InputError unless the table has 4 to 200 points, all finite, x increasing, and the curve is positive in
  /// between.
  explicit LimitCurve(const Table& table);

  double value(double x) const { return at(x).value; }
  double slope(double x) const { return at(x).slope; }
  double curvature(double x) const { return at(x).curvature; }
  double lower_end() const { return first_; }
  double upper_end() const { return last_; }
  double largest() const { return largest_; }  ///< limit of the table

 private:
  struct Values {
    double value, slope, curvature;
  };
  Values at(double x) const;

  double first_, last_, largest_ = 0.0;
  Eigen::Spline<double, 1, 3> spline_;  // over [0, 1]
};

}  // namespace prowl

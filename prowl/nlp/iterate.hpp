#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

/// What is known of an iterate, whatever its variables are.
struct IterateFigures {
  double cost = std::numeric_limits<double>::infinity();
  double violation = std::numeric_limits<double>::infinity();
  double dual_violation = std::numeric_limits<double>::infinity();
};

/// Whether a solver that is stopped should rather give back `a`: less violation, and among those within tolerance less
/// cost. NaN is as bad as infinity.
inline bool is_better(const IterateFigures& a, const IterateFigures& b, double tolerance) {
  const auto size = [](double figure) { return std::isnan(figure) ? std::numeric_limits<double>::infinity() : figure; };
  const double violation_a = std::max(size(a.violation), tolerance),
               violation_b = std::max(size(b.violation), tolerance);
  return violation_a < violation_b || (violation_a == violation_b && size(a.cost) < size(b.cost));
}

}  // namespace prowl

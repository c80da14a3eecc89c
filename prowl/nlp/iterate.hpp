#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

/// Quality of an iterate, without its variables.
struct IterateFigures {
  double cost = std::numeric_limits<double>::infinity();
  double violation = std::numeric_limits<double>::infinity();
  double dual_violation = std::numeric_limits<double>::infinity();
};

/// True if a stopped solver should return `a` rather than `b`: less violation or, within the tolerance, less cost. NaN
/// counts as infinity.
inline bool is_better(const IterateFigures& a, const IterateFigures& b, double tolerance) {
  const auto size = [](double figure) { return std::isnan(figure) ? std::numeric_limits<double>::infinity() : figure; };
  const double violation_a = std::max(size(a.violation), tolerance),
               violation_b = std::max(size(b.violation), tolerance);
  return violation_a < violation_b || (violation_a == violation_b && size(a.cost) < size(b.cost));
}

}  // namespace prowl

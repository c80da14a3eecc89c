#pragma once

#include <algorithm>
#include <limits>

namespace prowl {

/// What is known of an iterate, whatever its variables are.
struct IterateFigures {
  double cost = std::numeric_limits<double>::infinity();
  double violation = std::numeric_limits<double>::infinity();
  double dual_violation = std::numeric_limits<double>::infinity();
};

/// Whether a solver that is stopped should rather give back `a`: less violation, and among those within tolerance less cost.
inline bool is_better(const IterateFigures& a, const IterateFigures& b, double tolerance) {
  const double violation_a = std::max(a.violation, tolerance), violation_b = std::max(b.violation, tolerance);
  return violation_a < violation_b || (violation_a == violation_b && a.cost < b.cost);
}

}  // namespace prowl

#include "prowl/task_file/toml/number_range.hpp"

#include <fmt/format.h>

#include <cmath>

namespace prowl {

std::string NumberRange::limits() const {
  const bool has_lower = std::isfinite(lower);
  const bool has_upper = std::isfinite(upper);
  if (has_lower && has_upper) return fmt::format("from {:g} to {:g}", lower, upper);
  if (has_lower) return fmt::format("{} {:g}", above_lower ? ">" : ">=", lower);
  if (has_upper) return fmt::format("<= {:g}", upper);
  return "";
}

bool NumberRange::contains(double value) const {
  return std::abs(value) <= kLargest && value <= upper && (above_lower ? value > lower : value >= lower);
}

double NumberRange::any_inside() const {
  for (const double value : {1.0, 0.0, 0.5 * (lower + upper), lower + 1.0, upper - 1.0, lower, upper}) {
    if (std::isfinite(value) && contains(value)) return value;
  }
  return 0.0;
}

}  // namespace prowl

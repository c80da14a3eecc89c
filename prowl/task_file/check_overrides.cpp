#include "prowl/task_file/check_overrides.hpp"

#include <fmt/format.h>

#include <limits>

#include "prowl/error.hpp"

namespace prowl {

void check_overrides(const SourceText& task_file, const TaskOverrides& overrides) {
  constexpr double kShortestSolve = 1e-9, kLongestSolve = 1e9;  // [s]; no time at all, and 30 years
  const auto check = [&](const char* name, auto value, auto lower, auto upper) {
    if (!value || (*value >= lower && *value <= upper)) return;
    throw InputError(fmt::format("{}: {} = {} in place of the file's is not allowed; need {} to {}",
                                 task_file.path.string(), name, *value, lower, upper));
  };
  check("intervals", overrides.intervals, 1, kMostIntervals);
  check("max_iterations", overrides.max_iterations, 1, std::numeric_limits<int>::max());
  check("max_time_s", overrides.max_seconds, kShortestSolve, kLongestSolve);
  check("tolerance", overrides.tolerance, 1e-12, 1e-2);
}

}  // namespace prowl

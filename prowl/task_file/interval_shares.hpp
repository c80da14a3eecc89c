#pragma once

#include <vector>

namespace prowl {

/// Distributes `total` mesh intervals over the phases in proportion to `counts` of the task file, those that rounding
/// leaves to the largest fractions; at least one each.
std::vector<int> share_intervals(const std::vector<int>& counts, int total);

}  // namespace prowl

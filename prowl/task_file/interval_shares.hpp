#pragma once

#include <vector>

namespace prowl {

/// `total` mesh intervals, shared out over phases in proportion to the `counts` of the task file; at least one each.
std::vector<int> share_intervals(const std::vector<int>& counts, int total);

}  // namespace prowl

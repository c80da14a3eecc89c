#include "prowl/task_file/interval_shares.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace prowl {

std::vector<int> share_intervals(const std::vector<int>& counts, int total) {
  const int sum = std::accumulate(counts.begin(), counts.end(), 0);
  std::vector<int> shares;
  for (const int count : counts) {
    shares.push_back(std::max(1, static_cast<int>(std::lround(static_cast<double>(total) * count / sum))));
  }
  return shares;
}

}  // namespace prowl

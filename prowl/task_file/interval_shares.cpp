#include "prowl/task_file/interval_shares.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numeric>

namespace prowl {

std::vector<int> share_intervals(const std::vector<int>& counts, int total) {
  const double sum = std::accumulate(counts.begin(), counts.end(), 0.0);
  const auto exact = [&](std::size_t p) { return total * counts[p] / sum; };
  std::vector<int> shares;
  std::vector<std::size_t> by_rest(counts.size());
  std::iota(by_rest.begin(), by_rest.end(), 0u);
  for (const std::size_t p : by_rest) shares.push_back(std::max(1, static_cast<int>(exact(p))));
  std::ranges::stable_sort(by_rest, std::greater{}, [&](std::size_t p) { return exact(p) - std::floor(exact(p)); });
  int left = total - std::accumulate(shares.begin(), shares.end(), 0);
  for (std::size_t i = 0; left > 0; ++i, --left) ++shares[by_rest[i % by_rest.size()]];
  return shares;
}

}  // namespace prowl

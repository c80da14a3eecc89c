#include "prowl/mesh/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "prowl/error.hpp"

namespace prowl {
namespace {

constexpr double kPhaseRounding = 1e-9;  // of a phase

}  // namespace

PhaseMesh::PhaseMesh(int intervals) : intervals_(intervals) {
  if (intervals < 1) throw InputError(fmt::format("intervals: {} is not allowed; need 1 or more", intervals));
}

PhaseMesh::PhaseMesh(const std::vector<double>& lengths) : PhaseMesh(static_cast<int>(lengths.size())) {
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    if (lengths[i] > 0.0 && std::isfinite(lengths[i])) continue;
    throw InputError(fmt::format("shares[{}]: {} is not allowed; need a part of the phase, > 0", i, lengths[i]));
  }
  const auto [shortest, longest] = std::ranges::minmax(lengths);
  if (longest - shortest <= kPhaseRounding * longest) return;
  const double sum = std::accumulate(lengths.begin(), lengths.end(), 0.0);
  constexpr double kIsOne = 1e-12;
  shares_ = lengths;
  if (std::abs(sum - 1.0) < kIsOne) return;  // shares already, kept to the last bit
  for (double& share : shares_) share /= sum;
}

double PhaseMesh::step(int i, double duration) const {
  return is_even() ? duration / intervals_ : duration * shares_[i];
}

double PhaseMesh::node_time(int k, double duration) const {
  if (k == intervals_) return duration;
  if (is_even()) return duration * k / intervals_;
  return duration * std::accumulate(shares_.begin(), shares_.begin() + k, 0.0);
}

std::optional<int> PhaseMesh::node_at(double fraction) const {
  double at = 0.0;
  for (int k = 0; k <= intervals_; ++k) {
    if (std::abs(at - fraction) <= kPhaseRounding) return k;
    if (k < intervals_) at += step(k, 1.0);
  }
  return std::nullopt;
}

PhaseMesh PhaseMesh::with_intervals(int count) const {
  if (is_even()) return PhaseMesh(count);
  const auto fraction_at = [&](int j) {  // of node j, as a part of the phase
    const int before = static_cast<int>(static_cast<long>(j) * intervals_ / count);
    const double rest = static_cast<double>(j) * intervals_ / count - before;
    return node_time(before, 1.0) + (before < intervals_ ? rest * step(before, 1.0) : 0.0);
  };
  std::vector<double> lengths;
  for (int j = 0; j < count; ++j) lengths.push_back(fraction_at(j + 1) - fraction_at(j));
  return PhaseMesh(lengths);
}

int Mesh::num_intervals() const {
  int count = 0;
  for (const PhaseMesh& phase : phases) count += phase.intervals();
  return count;
}

int Mesh::node(int phase, int k) const {
  int first = 0;
  for (int p = 0; p < phase; ++p) first += phases[p].intervals() + 1;
  return first + k;
}

bool Mesh::is_even() const { return std::ranges::all_of(phases, &PhaseMesh::is_even); }

Mesh mesh_with_rate(const std::vector<Phase>& phases, double intervals_per_second) {
  constexpr int kFewest = 2;
  Mesh mesh;
  for (const Phase& phase : phases) {
    const double intervals =
        phase.duration.max * intervals_per_second * (1.0 - kPhaseRounding);  // 0.3 s at 50/s: 15, not 16
    mesh.phases.emplace_back(std::max(kFewest, static_cast<int>(std::ceil(intervals))));
  }
  return mesh;
}

}  // namespace prowl

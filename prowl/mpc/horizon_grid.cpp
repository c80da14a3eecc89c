#include "prowl/mpc/horizon_grid.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {
namespace {

/// Switches nearer to each other, or to the start, count as one [s]: a step that short costs as much as a long one.
constexpr double kShortestStep = 4e-3;

/// Growth r of steps with first (1 + r + ... + r^(n - 1)) = length; at least 1.
double growth(int steps, double first, double length) {
  double low = 1.0, high = 2.0;
  const auto sum = [&](double r) {
    double total = 0.0, step = first;
    for (int i = 0; i < steps; ++i, step *= r) total += step;
    return total;
  };
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (sum(middle) < length ? low : high) = middle;
  }
  return low;
}

}  // namespace

HorizonGrid::HorizonGrid(int steps, double first, double length) {
  const double r = growth(steps, std::min(first, length / steps), length);
  double step = 1.0;
  nominal_.push_back(0.0);
  for (int i = 0; i < steps; ++i, step *= r) nominal_.push_back(nominal_.back() + step);
  const double scale = length / nominal_.back();
  for (double& t : nominal_) t *= scale;
  times_ = nominal_;
  switches_.reserve(256);
  snapped_.reserve(nominal_.size());
}

void HorizonGrid::lay(double start, const ContactTimeline& timeline) {
  const int steps = num_steps();
  // A switch just before the end counts once it leaves room for half of the last step.
  const double last_step = nominal_[static_cast<std::size_t>(steps)] - nominal_[static_cast<std::size_t>(steps) - 1];
  switches_.clear();
  timeline.add_switches(start + kShortestStep, start + length() - 0.5 * last_step, switches_);
  std::sort(switches_.begin(), switches_.end());
  // Each alone, and no more than there are nodes inside.
  std::size_t count = 0;
  double last = start;
  for (const double t : switches_) {
    if (t < last + kShortestStep || static_cast<int>(count) + 1 >= steps) continue;
    switches_[count++] = last = t;
  }
  snapped_.assign(1, 0);
  times_.front() = start;
  for (std::size_t i = 0; i < count; ++i) {
    const double t = switches_[i] - start;
    int k = static_cast<int>(std::lower_bound(nominal_.begin(), nominal_.end(), t) - nominal_.begin());
    if (k > 0 && t - nominal_[k - 1] < nominal_[k] - t) --k;
    k = std::clamp(k, snapped_.back() + 1, steps - static_cast<int>(count - i));
    times_[k] = switches_[i];
    snapped_.push_back(k);
  }
  times_[steps] = start + length();
  snapped_.push_back(steps);
  for (std::size_t i = 0; i + 1 < snapped_.size(); ++i) {
    const int from = snapped_[i], to = snapped_[i + 1];
    for (int k = from + 1; k < to; ++k) {
      const double share = (nominal_[k] - nominal_[from]) / (nominal_[to] - nominal_[from]);
      times_[k] = times_[from] + share * (times_[to] - times_[from]);
    }
  }
}

int HorizonGrid::step_at(double t) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  return static_cast<int>(after - times_.begin()) - 1;
}

}  // namespace prowl

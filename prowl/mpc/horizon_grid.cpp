#include "prowl/mpc/horizon_grid.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {
namespace {

/// Switches nearer to each other, or to the start, count as one: a step that short costs as much as a long one, which
/// is then missing elsewhere. At least [s], and a share of the step that a grid without switches has there. (Values of
/// 0.4 to 1 let robots walk equally well; with none HyQ follows commands worse, and needs more iterations.)
constexpr double kShortestStep = 4e-3, kShortestShare = 0.5;

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
  spans_.reserve(nominal_.size());
}

void HorizonGrid::lay(double start, const ContactTimeline& timeline) {
  choose_switches(start, timeline);
  switches_.push_back(start + length());
  // Between two switches as many steps as the growing ones have there, but at least one.
  spans_.clear();
  double begin = 0.0;
  for (const double t : switches_) {
    const double end = index_at(t - start);
    spans_.push_back({begin, end, 1});
    begin = end;
  }
  const auto share = [](const Span& span) { return (span.end - span.begin) / span.steps; };
  for (int left = num_steps() - static_cast<int>(spans_.size()); left > 0; --left)
    ++std::ranges::max_element(spans_, {}, share)->steps;
  auto time = times_.begin();
  *time = start;
  for (std::size_t i = 0; i < spans_.size(); ++i) {
    const Span& span = spans_[i];
    for (int k = 1; k < span.steps; ++k)
      *++time = start + time_at(span.begin + (span.end - span.begin) * k / span.steps);
    *++time = switches_[i];
  }
}

/// Each alone, and no more than there are nodes inside.
void HorizonGrid::choose_switches(double start, const ContactTimeline& timeline) {
  const auto steps = nominal_.size() - 1;
  // A switch just before the end counts once it leaves room for half of the last step.
  const double last_step = nominal_[steps] - nominal_[steps - 1];
  switches_.clear();
  timeline.add_switches(start + kShortestStep, start + length() - 0.5 * last_step, switches_);
  std::sort(switches_.begin(), switches_.end());
  std::size_t count = 0;
  for (const double t : switches_) {
    const auto k = static_cast<std::size_t>(index_at(t - start));
    const double shortest = std::max(kShortestStep, kShortestShare * (nominal_[k + 1] - nominal_[k]));
    const bool is_alone = count == 0 || t >= switches_[count - 1] + shortest;
    if (is_alone && count + 1 < steps) switches_[count++] = t;
  }
  switches_.resize(count);
}

double HorizonGrid::index_at(double t) const {
  const auto after = std::upper_bound(nominal_.begin() + 1, nominal_.end() - 1, t);
  return static_cast<double>(after - nominal_.begin()) - (*after - t) / (*after - *(after - 1));
}

double HorizonGrid::time_at(double index) const {
  const auto k = std::min(static_cast<std::size_t>(index), nominal_.size() - 2);
  return nominal_[k] + (index - static_cast<double>(k)) * (nominal_[k + 1] - nominal_[k]);
}

int HorizonGrid::step_at(double t) const {
  const auto after = std::upper_bound(times_.begin() + 1, times_.end() - 1, t);
  return static_cast<int>(after - times_.begin()) - 1;
}

}  // namespace prowl

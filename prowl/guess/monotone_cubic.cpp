#include "prowl/guess/monotone_cubic.hpp"

#include <algorithm>
#include <cassert>

namespace prowl {

MonotoneCubic::MonotoneCubic(const std::vector<Waypoint>& waypoints) {
  assert(!waypoints.empty());
  for (const Waypoint& waypoint : waypoints) {
    assert(times_.empty() || waypoint.time > times_.back());
    times_.push_back(waypoint.time);
    values_.push_back(waypoint.value);
    slopes_.push_back(waypoint.slope.value_or(0.0));
  }
  for (std::size_t i = 1; i + 1 < times_.size(); ++i) {
    if (waypoints[i].slope) continue;
    const double h0 = times_[i] - times_[i - 1], h1 = times_[i + 1] - times_[i];
    const double secant0 = (values_[i] - values_[i - 1]) / h0, secant1 = (values_[i + 1] - values_[i]) / h1;
    if (secant0 * secant1 <= 0.0) continue;
    slopes_[i] = 3.0 * (h0 + h1) / ((2.0 * h1 + h0) / secant0 + (h1 + 2.0 * h0) / secant1);
  }
}

double MonotoneCubic::operator()(double time) const {
  if (time <= times_.front()) return values_.front();
  if (time >= times_.back()) return values_.back();
  const auto i = static_cast<std::size_t>(std::upper_bound(times_.begin(), times_.end(), time) - times_.begin()) - 1;
  const double h = times_[i + 1] - times_[i];
  const double s = (time - times_[i]) / h;
  // Hermite form.
  const double rise = s * s * (3.0 - 2.0 * s);
  return values_[i] + rise * (values_[i + 1] - values_[i]) +
         h * s * (1.0 - s) * ((1.0 - s) * slopes_[i] - s * slopes_[i + 1]);
}

}  // namespace prowl

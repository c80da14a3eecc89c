#include "prowl/mpc/contact_timeline.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "prowl/error.hpp"

namespace prowl {
namespace {

constexpr std::size_t kMostSwings = 64;  // of a foot at a time; a horizon contains two or three
constexpr double kRemembered = 1.0;      // [s]
/// A foot that has not landed when a plan is made does not carry at the start of that plan, for so long [s].
constexpr double kSoon = 5e-3;
constexpr double kSameTime = 1e-6;        ///< of a landing and a node of a horizon that ends there [s]
constexpr double kLongestStride = 5.0;    // [s]
constexpr double kShortestStance = 0.02;  // between two swings of a foot [s]

}  // namespace

ContactTimeline::ContactTimeline(int num_feet, double start)
    : next_lift_(start), feet_(static_cast<std::size_t>(num_feet), Foot{.felt = start}) {
  for (Foot& foot : feet_) foot.swings.reserve(kMostSwings);
  waiting_.reserve(kMostSwings * feet_.size());
}

void ContactTimeline::follow(const SteppingPattern& pattern) {
  for (const std::vector<int>& group : pattern.groups) {
    for (const int foot : group) {
      if (foot < 0 || foot >= num_feet()) throw InputError(fmt::format("stepping pattern: no foot {}", foot));
    }
  }
  if (!(pattern.stride > 0.0 && pattern.stride <= kLongestStride && pattern.duty_factor > 0.0 &&
        pattern.duty_factor < 1.0))
    throw InputError(
        fmt::format("stepping pattern: stride {:g} s and duty factor {:g}; need more than 0, at most {:g} s and 1",
                    pattern.stride, pattern.duty_factor, kLongestStride));
  pattern_ = pattern;
  next_group_ = 0;
}

void ContactTimeline::extend(double now, double until) {
  for (Foot& foot : feet_) {
    while (!foot.swings.empty() && foot.swings.front().land < now - kRemembered) foot.swings.erase(foot.swings.begin());
  }
  if (pattern_.stands()) {
    next_lift_ = std::max(next_lift_, until);
    return;
  }
  // After a long pause in the same phase of a stride, without the swings that nobody planned.
  if (next_lift_ < now - kRemembered) next_lift_ += pattern_.stride * std::floor((now - next_lift_) / pattern_.stride);
  const bool waits = keeps_three_feet();
  while (next_lift_ < until) {
    for (const int foot : pattern_.groups[next_group_]) {
      std::vector<Swing>& swings = of(foot).swings;
      const double lift = swings.empty() ? next_lift_ : std::max(next_lift_, swings.back().land + kShortestStance);
      if (swings.size() < kMostSwings)
        swings.push_back({lift, lift + pattern_.swing(), lift + pattern_.swing(), lift, waits});
    }
    next_lift_ += pattern_.stride / static_cast<double>(pattern_.groups.size());
    next_group_ = (next_group_ + 1) % pattern_.groups.size();
  }
}

const ContactTimeline::Swing* ContactTimeline::swing(int foot, double t) const {
  for (const Swing& swing : of(foot).swings) {
    if (swing.lift <= t && t < swing.land) return &swing;
  }
  return nullptr;
}

unsigned ContactTimeline::standing(double t) const {
  unsigned bits = 0;
  for (int f = 0; f < num_feet(); ++f) {
    if (!swing(f, t)) bits |= 1U << f;
  }
  return bits;
}

const ContactTimeline::Swing* ContactTimeline::unfelt(int foot, double t) const {
  const Swing* latest = nullptr;
  for (const Swing& swing : of(foot).swings) {
    if (swing.land <= t) latest = &swing;
  }
  return latest && !latest->has_touched && t - latest->land <= kLandingTime ? latest : nullptr;
}

void ContactTimeline::add_switches(double from, double to, std::vector<double>& switches) const {
  for (const Foot& foot : feet_) {
    for (const Swing& swing : foot.swings) {
      for (const double t : {swing.lift, swing.land}) {
        if (t > from && t < to) switches.push_back(t);
      }
    }
  }
}

void ContactTimeline::feel(int foot, bool touches, double t, double soon) {
  Foot& it = of(foot);
  std::vector<Swing>& swings = it.swings;
  const auto next = std::ranges::find_if(swings, [t](const Swing& swing) { return swing.lift > t; });
  const bool lifts_soon = next != swings.end() && next->lift < t + soon;
  it.touches = touches;
  if (touches) it.felt = t;
  if (next == swings.begin() || std::prev(next)->has_touched) {
    if (t - it.felt > kLost && !lifts_soon && swings.size() < kMostSwings)
      swings.insert(next, {.lift = it.felt, .land = t + soon, .planned = t, .first_lift = it.felt});
    return;
  }
  Swing& latest = *std::prev(next);
  if (touches && t > 0.5 * (latest.lift + latest.planned)) {
    latest.land = std::min(latest.land, t);
    latest.has_touched = true;
  } else if (!touches && !lifts_soon && t < latest.planned + kMostLate) {
    latest.land = std::max(latest.land, t + soon);
  }
}

void ContactTimeline::feel(const std::vector<bool>& touches, double t, double delay) {
  for (int f = 0; f < num_feet(); ++f) feel(f, touches[static_cast<std::size_t>(f)], t, delay + kSoon);
  await_landings(t, delay + kSoon);
}

/// If its groups swing one after the other.
bool ContactTimeline::keeps_three_feet() const {
  constexpr std::size_t kSupport = 3;
  const auto stands = [this](const std::vector<int>& group) { return feet_.size() >= group.size() + kSupport; };
  return std::ranges::all_of(pattern_.groups, stands);
}

/// A robot on two feet of a walk tips over. A foot that has waited lifts off `soon` [s] after t at the earliest, as
/// the plan that acts until then has it on the ground. Its own lost contact does not delay it. Longer waits are worse:
/// with 20 ms more, twice as many plans of Go2 fail when it walks with kicks of 0.7 m/s.
void ContactTimeline::await_landings(double t, double soon) {
  waiting_.clear();
  for (Foot& foot : feet_) {
    for (Swing& swing : foot.swings) {
      if (swing.waits && swing.lift > t) waiting_.push_back({&foot, &swing});
    }
  }
  std::ranges::sort(waiting_, {}, [](const Waiting& waiting) { return waiting.swing->first_lift; });
  for (const auto& [foot, swing] : waiting_) {
    double lift = std::max(swing->first_lift, std::min(swing->lift, t + soon));
    for (const Foot& other_foot : feet_) {
      if (&other_foot == foot) continue;
      for (const Swing& other : other_foot.swings) {
        const double first_landing = other.first_lift + (other.planned - other.lift);
        if (first_landing < swing->first_lift + kSameTime) lift = std::max(lift, other.land);
      }
    }
    const double duration = swing->planned - swing->lift;
    swing->lift = lift;
    swing->land = swing->planned = lift + duration;
  }
}

double ContactTimeline::lateness(int foot, double landing, double t) const {
  for (const Swing& swing : of(foot).swings) {
    if (std::abs(swing.land - landing) < kSameTime) return swing.has_touched ? 0.0 : std::max(0.0, t - swing.planned);
  }
  return 0.0;
}

}  // namespace prowl

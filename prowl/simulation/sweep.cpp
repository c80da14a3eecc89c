#include "prowl/simulation/sweep.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <future>
#include <limits>
#include <mutex>
#include <numbers>
#include <random>
#include <optional>
#include <thread>

namespace prowl {
namespace {

using Uniform = boost::random::uniform_real_distribution<double>;

/// Fewest contacts that hold at a time between `from` and `to`.
long fewest_contacts(const Tracker& tracker, double from, double to) {
  long fewest = std::numeric_limits<long>::max();
  for (const TrackingPlan::Segment& segment : tracker.plan().segments) {
    if (segment.end < from || segment.start > to) continue;
    fewest = std::min(fewest, std::ranges::count(segment.in_contact, true));
  }
  return fewest;
}

/// A push of this impulse in a direction and at a moment drawn from `random`.
Push draw_push(const Tracker& tracker, double impulse, double on_two_feet, double duration, std::mt19937_64& random) {
  const double angle = Uniform(0.0, 2.0 * std::numbers::pi)(random);
  const double time = Uniform(tracker.start(), tracker.end())(random);
  const double size = fewest_contacts(tracker, time, time + duration) <= 2 ? on_two_feet : impulse;
  return {size * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0), time, duration};
}

}  // namespace

SimulationOptions perturbed(const Tracker& tracker, const SimulationOptions& options, const PerturbationRanges& ranges, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  SimulationOptions result = options;
  result.seed = random();  // the sensors' numbers are others than these
  result.physics.mass_scale = Uniform(1.0 - ranges.mass, 1.0 + ranges.mass)(random);
  result.physics.friction = Uniform(ranges.friction_low, ranges.friction_high)(random);
  result.pushes = {draw_push(tracker, ranges.push, ranges.push_on_two_feet, ranges.push_duration, random)};
  return result;
}

std::string pushed_phase(const Tracker& tracker, const SimulationOptions& options) {
  if (options.pushes.empty()) return "";
  return tracker.segment(options.pushes.front().time + 0.5 * options.pushes.front().duration).name;
}

std::vector<SweepCase> run_cases(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                 const std::vector<SimulationOptions>& options, const std::function<void(int)>& on_done,
                                 const std::atomic<bool>* interrupt) {
  std::vector<std::optional<SweepCase>> cases(options.size());
  std::atomic<std::size_t> next = 0;
  std::mutex report;
  int done = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < options.size(); i = next++) {
      if (interrupt && *interrupt) return;
      cases[i] = SweepCase{options[i], simulate(problem, tracker, criteria, options[i])};
      const std::lock_guard lock(report);
      ++done;
      if (on_done) on_done(done);
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
    workers.push_back(std::async(std::launch::async, work));
  }
  for (std::future<void>& worker : workers) worker.get();
  std::vector<SweepCase> finished;
  for (std::optional<SweepCase>& one : cases) {
    if (!one) break;
    finished.push_back(std::move(*one));
  }
  return finished;
}

SuccessRate success_rate(int successes, int cases) {
  SuccessRate rate{successes, cases};
  if (cases == 0) return rate;
  using Binomial = boost::math::binomial_distribution<double>;
  constexpr double kTail = 0.025;
  rate.lower = Binomial::find_lower_bound_on_p(cases, successes, kTail);
  rate.upper = Binomial::find_upper_bound_on_p(cases, successes, kTail);
  return rate;
}

std::vector<Breakdown> find_breakdowns(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                       const SimulationOptions& options, std::uint64_t seed, int cases,
                                       const std::function<void(const std::string&)>& on_kind,
                                       const std::atomic<bool>* interrupt) {
  struct Kind {
    const char* name;
    const char* unit;
    double first, most;  ///< sizes to try: first, doubled up to most
    std::function<void(SimulationOptions&, double, std::mt19937_64&)> apply;
  };
  const std::vector<Kind> kinds = {
      {"masses larger by", "%", 10.0, 320.0, [](auto& o, double x, auto&) { o.physics.mass_scale = 1.0 + 0.01 * x; }},
      {"masses smaller by", "%", 10.0, 80.0, [](auto& o, double x, auto&) { o.physics.mass_scale = 1.0 - 0.01 * x; }},
      {"friction lower by", "%", 10.0, 80.0,
       [&](auto& o, double x, auto&) {
         const double planned = problem.surfaces.empty() ? 0.5 : problem.surfaces.front().friction;
         o.physics.friction = (1.0 - 0.01 * x) * options.physics.friction.value_or(planned);
       }},
      {"push of", "N s", 5.0, 160.0,
       [&](auto& o, double x, auto& random) { o.pushes = {draw_push(tracker, x, x, PerturbationRanges{}.push_duration, random)}; }},
      {"sensor noise times", "", 2.0, 64.0, [](auto& o, double x, auto&) { o.noise_scale = x; }},
      {"unknown delay of", "ms", 1.0, 32.0, [](auto& o, double x, auto&) { o.unknown_delay = 1e-3 * x; }},
  };
  const auto survives = [&](const Kind& kind, double size) {
    std::vector<SimulationOptions> all(static_cast<std::size_t>(cases), options);
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::mt19937_64 random(seed + i);
      all[i].seed = random();
      kind.apply(all[i], size, random);
    }
    const auto done = run_cases(problem, tracker, criteria, all, {}, interrupt);
    return 2 * std::ranges::count_if(done, [](const SweepCase& one) { return one.result.success(); }) >= std::ssize(done);
  };

  std::vector<Breakdown> breakdowns;
  for (const Kind& kind : kinds) {
    if (interrupt && *interrupt) break;
    if (on_kind) on_kind(kind.name);
    Breakdown found{kind.name, kind.unit, 0.0, std::numeric_limits<double>::infinity()};
    for (double size = kind.first; size <= kind.most; size *= 2.0) {
      if (!survives(kind, size)) {
        found.fails = size;
        break;
      }
      found.holds = size;
    }
    constexpr int kHalvings = 3;
    for (int i = 0; i < kHalvings && std::isfinite(found.fails); ++i) {
      const double middle = 0.5 * (found.holds + found.fails);
      (survives(kind, middle) ? found.holds : found.fails) = middle;
    }
    breakdowns.push_back(found);
  }
  return breakdowns;
}

}  // namespace prowl

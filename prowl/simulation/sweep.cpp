#include "prowl/simulation/sweep.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <cmath>
#include <limits>
#include <mutex>
#include <optional>
#include <random>

#include "prowl/simulation/in_parallel.hpp"
#include "prowl/simulation/perturbations.hpp"

namespace prowl {
namespace {

/// A perturbation of one kind, of any size.
struct Kind {
  static constexpr int kHalvings = 3;
  const char* name;
  const char* unit;
  double first, most;  ///< sizes tried: first, doubled up to most
  std::function<void(SimulationOptions&, double, std::mt19937_64&)> apply;

  /// Upper bound on the number of sizes tried.
  int most_sizes() const {
    int sizes = kHalvings;
    for (double size = first; size <= most; size *= 2.0) ++sizes;
    return sizes;
  }
};

/// Kinds of perturbation.
std::vector<Kind> kinds_of_perturbation(const Tracker& tracker) {
  return {
      {"masses larger by", "%", 10.0, 320.0, [](auto& o, double x, auto&) { o.physics.mass_scale = 1.0 + 0.01 * x; }},
      {"masses smaller by", "%", 10.0, 80.0, [](auto& o, double x, auto&) { o.physics.mass_scale = 1.0 - 0.01 * x; }},
      {"friction lower by", "%", 10.0, 80.0,
       [](auto& o, double x, auto&) { o.physics.friction_scale = 1.0 - 0.01 * x; }},
      {"push of", "N s", 5.0, 160.0,
       [&tracker](auto& o, double x, auto& random) {
         o.pushes = {draw_push(tracker, x, x, PerturbationRanges{}.push_duration, random)};
       }},
      {"sensor noise times", "", 2.0, 64.0, [](auto& o, double x, auto&) { o.noise_scale = x; }},
      {"unknown delay of", "ms", 1.0, 32.0, [](auto& o, double x, auto&) { o.unknown_delay = 1e-3 * x; }},
  };
}

}  // namespace

std::vector<SweepCase> run_cases(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                 const std::vector<SimulationOptions>& options, const SweepProgress& on_done,
                                 const std::atomic<bool>* interrupt) {
  std::vector<std::optional<SweepCase>> cases(options.size());
  std::mutex report;
  int done = 0;
  const auto tell = [&] {
    if (on_done) on_done(done, static_cast<int>(options.size()));
  };
  tell();
  const auto work = [&](int i) {
    const auto at = static_cast<std::size_t>(i);
    cases[at] = SweepCase{options[at], simulate(problem, tracker, criteria, options[at])};
    const std::lock_guard lock(report);
    ++done;
    tell();
  };
  in_parallel(static_cast<int>(options.size()), 0, work, interrupt);
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

std::vector<Breakdown> find_breakdowns(const MotionProblem& problem, const Tracker& tracker,
                                       const SuccessCriteria& criteria, const SimulationOptions& options,
                                       std::uint64_t seed, int cases, const SweepProgress& on_done,
                                       const std::atomic<bool>* interrupt) {
  const std::vector<Kind> kinds = kinds_of_perturbation(tracker);
  int most = 0, done = 0;
  for (const Kind& kind : kinds) most += cases * kind.most_sizes();
  const auto interrupted = [&] { return interrupt && *interrupt; };
  const auto survives = [&](const Kind& kind, double size) {
    std::vector<SimulationOptions> all(static_cast<std::size_t>(cases), options);
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::mt19937_64 random(seed + i);
      all[i].seed = random();
      kind.apply(all[i], size, random);
    }
    const int before = done;
    const auto count = [&](int now, int) {
      done = before + now;
      if (on_done) on_done(done, most);
    };
    const auto finished = run_cases(problem, tracker, criteria, all, count, interrupt);
    return 2 * std::ranges::count_if(finished, [](const SweepCase& one) { return one.result.success(); }) >=
           std::ssize(finished);
  };

  std::vector<Breakdown> breakdowns;
  int counted = 0;
  for (const Kind& kind : kinds) {
    Breakdown found{kind.name, kind.unit, 0.0, std::numeric_limits<double>::infinity()};
    for (double size = kind.first; size <= kind.most && !interrupted(); size *= 2.0) {
      if (!survives(kind, size)) {
        found.fails = size;
        break;
      }
      found.holds = size;
    }
    for (int i = 0; i < Kind::kHalvings && std::isfinite(found.fails) && !interrupted(); ++i) {
      const double middle = 0.5 * (found.holds + found.fails);
      (survives(kind, middle) ? found.holds : found.fails) = middle;
    }
    if (interrupted()) break;
    breakdowns.push_back(found);
    done = counted += cases * kind.most_sizes();
    if (on_done) on_done(done, most);
  }
  return breakdowns;
}

}  // namespace prowl

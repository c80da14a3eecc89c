#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "prowl/simulation/simulation.hpp"

namespace prowl {

struct SweepCase {
  SimulationOptions options;
  SimulationResult result;  ///< without samples
};

/// Progress: simulations done, from 0 to total. May be empty.
using SweepProgress = std::function<void(int done, int total)>;

/// Runs simulate() on all `options`, one thread per core; the result does not depend on the number
/// of threads. `on_done` is called from any thread, one call at a time. When `interrupt` (may be
/// null) becomes true, no further case starts; the result contains the first cases of `options`.
std::vector<SweepCase> run_cases(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                 const std::vector<SimulationOptions>& options, const SweepProgress& on_done,
                                 const std::atomic<bool>* interrupt);

/// Success rate with its 95 % confidence interval (Clopper and Pearson, Biometrika 1934: exact,
/// hence conservative).
struct SuccessRate {
  int successes = 0, cases = 0;
  double rate() const { return cases > 0 ? static_cast<double>(successes) / cases : 0.0; }
  double lower = 0.0, upper = 1.0;
};
SuccessRate success_rate(int successes, int cases);

/// Size of a single kind of perturbation at which the success rate falls below one half.
struct Breakdown {
  std::string kind;  ///< "masses larger by", ...
  std::string unit;
  double holds = 0.0;  ///< largest tried size with at least half of the cases successful
  double fails = 0.0;  ///< smallest tried size above it with fewer; infinity if none
};

/// Finds the breakdown of each kind by bisection with `cases` simulations per size: masses larger
/// and smaller, less friction, pushes, noise, delay. The total of `on_done` is an upper bound;
/// skipped simulations count as done when a kind is finished. When `interrupt` (may be null)
/// becomes true, unfinished kinds are left out.
std::vector<Breakdown> find_breakdowns(const MotionProblem& problem, const Tracker& tracker,
                                       const SuccessCriteria& criteria, const SimulationOptions& options,
                                       std::uint64_t seed, int cases, const SweepProgress& on_done,
                                       const std::atomic<bool>* interrupt);

}  // namespace prowl

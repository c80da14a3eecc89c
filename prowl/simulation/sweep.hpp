#pragma once

#include <atomic>
#include <functional>

#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// How far the simulated world may be from the planned one. Everything is drawn from uniform distributions.
struct PerturbationRanges {
  double mass = 0.1;  ///< factor on all masses from 1 - mass to 1 + mass
  double friction_low = 0.4, friction_high = 0.8;
  double push = 10.0;             ///< impulse on the base, random horizontal direction [N s]
  double push_on_two_feet = 2.0;  ///< the same while two feet or fewer are down [N s]
  double push_duration = 0.1;     ///< it starts at a random moment of the motion [s]
  bool operator==(const PerturbationRanges&) const = default;
};

/// Options of case `seed`: those given, with mass, friction, a push and the sensors' noise drawn from `seed` alone.
SimulationOptions perturbed(const Tracker& tracker, const SimulationOptions& options, const PerturbationRanges& ranges,
                            std::uint64_t seed);

/// Phase at the middle of the first push.
std::string pushed_phase(const Tracker& tracker, const SimulationOptions& options);

struct SweepCase {
  SimulationOptions options;
  SimulationResult result;  ///< without samples
};

/// Told of progress, from 0 on: how many simulations are done, of how many. May be empty.
using SweepProgress = std::function<void(int done, int total)>;

/// Runs `simulate` on all of `options`, on as many threads as there are cores. The result does not depend on their
/// number. `on_done` is called from any of them, one at a time. Once `interrupt` (may be null) is true no further case
/// is begun: the result has those that were, the first of `options`.
std::vector<SweepCase> run_cases(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                 const std::vector<SimulationOptions>& options, const SweepProgress& on_done,
                                 const std::atomic<bool>* interrupt);

/// Share of successes, and the interval that holds the true rate with 95 % (Clopper and Pearson, Biometrika 1934:
/// exact, so rather too wide than too narrow).
struct SuccessRate {
  int successes = 0, cases = 0;
  double rate() const { return cases > 0 ? static_cast<double>(successes) / cases : 0.0; }
  double lower = 0.0, upper = 1.0;
};
SuccessRate success_rate(int successes, int cases);

/// Size of one kind of perturbation, alone, at which success falls under one half.
struct Breakdown {
  std::string kind;  ///< "mass", ...
  std::string unit;
  double holds = 0.0;  ///< largest tried at which at least half of the cases succeed
  double fails = 0.0;  ///< smallest tried above it at which fewer do; infinity if none was found
};

/// Looks for it by bisection, `cases` simulations at a time: heavier, lighter, smoother ground, pushes, noise, delay.
/// `on_done`: of as many simulations as it may take; those that a kind does not need count as done when it is found.
/// Kinds that are not found when `interrupt` (may be null) turns true are left out.
std::vector<Breakdown> find_breakdowns(const MotionProblem& problem, const Tracker& tracker,
                                       const SuccessCriteria& criteria, const SimulationOptions& options,
                                       std::uint64_t seed, int cases, const SweepProgress& on_done,
                                       const std::atomic<bool>* interrupt);

}  // namespace prowl

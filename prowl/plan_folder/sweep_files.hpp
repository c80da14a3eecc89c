#pragma once

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/simulation/perturbations.hpp"
#include "prowl/simulation/sweep.hpp"

namespace prowl {

/// Options and result of `prowl sweep`.
struct SweepRecord {
  std::uint64_t first_seed = 1;
  int asked = 0;  ///< number of cases; after an interrupt more than in `cases`
  PerturbationRanges ranges;
  std::vector<std::string> only = {};  ///< kinds of perturbations that are drawn; empty: all
  std::vector<SweepCase> cases = {};   ///< of seeds first_seed, first_seed + 1, ...
  std::vector<Breakdown> breakdowns = {};
  bool interrupted = false;  ///< cases or breakdowns are missing
};

std::string sweep_summary(const PlanRecord& plan, const Tracker& tracker, const SweepRecord& record);
/// sweep.json (docs/simulation.md).
std::string sweep_json(const PlanRecord& plan, const Tracker& tracker, const SweepRecord& record);

}  // namespace prowl

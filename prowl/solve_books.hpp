#pragma once

#include <vector>

#include "prowl/plan.hpp"

namespace prowl {

/// Iterations and times of several solves for one plan.
class SolveBooks {
 public:
  void add(const Plan& plan) {
    levels_.insert(levels_.end(), plan.levels.begin(), plan.levels.end());
    total_.iterations += plan.result.iterations;
    total_.seconds += plan.result.seconds;
    total_.times += plan.result.times;
  }
  void add_seconds(double seconds) { total_.seconds += seconds; }  ///< of something beside the solves

  /// Replaces times and iterations of one solve by those of all.
  void enter(Plan& plan) const {
    plan.levels = levels_;
    plan.result.iterations = total_.iterations;
    plan.result.seconds = total_.seconds;
    plan.result.times = total_.times;
  }

 private:
  SolveResult total_;
  std::vector<LevelResult> levels_;
};

}  // namespace prowl

#pragma once

#include <optional>
#include <string>

#include "prowl/refine.hpp"
#include "prowl/robust/tube.hpp"

namespace prowl {

/// What a plan is robust against.
struct Robustness {
  Disturbances sizes;    ///< asked for
  double share = 0.0;    ///< of the sizes, for which the plan leaves the margins that its tube needs [-]
  int solves = 0;        ///< with margins
  std::string tightest;  ///< limit and moment that allow no larger share, in words

  bool is_full() const { return share == 1.0; }
};

struct RobustPlan {
  Plan plan;
  Robustness robustness;
  bool is_stopped = false;  ///< a limit of time, or an interrupt, ended the search for a larger share
};

/// Robust motion by zero-order robust optimisation (docs/robust.md): alternates the tube of a motion and a solve with
/// its margins fixed, on the mesh of `asked`, then refines. Without `refine` the mesh of `nominal` is kept. `nominal`:
/// a good plan of `asked`, on any mesh; it is returned where no margins have a motion. SolverOptions::max_seconds holds
/// for all solves together. Throws what make_refined_plan() and design_feedback() throw.
RobustPlan make_robust_plan(const DiscreteProblem& asked, Plan nominal, const TrackingOptions& tracking,
                            const Disturbances& sizes, const NlpSolver& solver, const PlanOptions& options,
                            const std::optional<RefineOptions>& refine);

}  // namespace prowl

#pragma once

#include <functional>

#include "prowl/certificate/mesh_errors.hpp"
#include "prowl/plan.hpp"

namespace prowl {

/// Result on one mesh.
struct RefineRound {
  int intervals = 0;
  int iterations = 0;
  double error = 0.0;  ///< largest local integration error, estimated by step_errors() [-]
  int too_coarse = 0;  ///< intervals that need shorter steps
};

struct RefineOptions {
  MeshTolerance tolerance;
  /// The mesh of the problem is only a start (first_mesh()): where its solve fails, halves of its intervals are tried,
  /// then quarters. False: it is a user's, and the coarsest mesh of make_plan() is the start.
  bool mesh_is_open = false;
  int max_rounds = 24;                                    ///< solves, including the first
  std::function<void(const RefineRound&)> on_round = {};  ///< after each solve that converged; may be empty
};

struct RefinedPlan {
  Plan plan;
  bool meets_tolerance = false;  ///< if not, a hint of the plan explains it
  bool interrupted = false;      ///< before the refinement ended; the plan may still be good
};

/// Solves on one mesh after the other until the motion meets the tolerance and passes its certificate. Each solve
/// starts from the motion before, with its deferred_corrections(), and is loose until that motion nearly meets the
/// tolerance. Intervals whose step_errors() a correction does not remove are split. So are those where another check of
/// the certificate fails, or errors do not fall. A mesh that fails from the motion before is solved from the task
/// again. SolverOptions::max_seconds is for all solves and certificates: no solve begins after it.
///
/// Without success, returns the motion with the least errors. A solve without convergence, or an interrupt, ends it.
RefinedPlan make_refined_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options,
                              const RefineOptions& refine);

}  // namespace prowl

#pragma once

#include <functional>

#include "prowl/certificate/mesh_errors.hpp"
#include "prowl/plan.hpp"

namespace prowl {

/// Result on one mesh.
struct RefineRound {
  int intervals = 0;
  int iterations = 0;
  MeshTolerance errors;  ///< worst of the motion
  int too_coarse = 0;    ///< intervals with errors above the tolerance
};

struct RefineOptions {
  MeshTolerance tolerance;
  /// Ends at the first plan that passes and meets the tolerance, rather than saving more intervals. The mesh of the
  /// problem is only a start: where its solve fails, halves of its intervals are tried, then quarters. A finer mesh
  /// that fails from the motion before is solved from the task again.
  bool ends_when_met = false;
  int max_rounds = 12;                                    ///< solved meshes, including the first
  std::function<void(const RefineRound&)> on_round = {};  ///< after each mesh that converged; may be empty
};

struct RefinedPlan {
  Plan plan;
  bool meets_tolerance = false;  ///< if not, a hint of the plan explains it
  bool interrupted = false;      ///< before the refinement ended; the plan may still be good
};

/// Repeats make_plan() on meshes that follow the errors measured on the one before (mesh_refinement.hpp), each from the
/// motion of the last. Starts on the coarsest mesh of make_plan(); ends when the motion meets the tolerance and,
/// without ends_when_met, the next mesh would save less than a fifth of the intervals. SolverOptions::max_seconds is
/// for all meshes and certificates: no mesh begins after it.
///
/// Returns the plan with the fewest intervals among those that meet the tolerance, preferring those that pass their
/// certificate; otherwise the plan nearest to the tolerance. A mesh without convergence, or an interrupt, ends it.
RefinedPlan make_refined_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options,
                              const RefineOptions& refine);

}  // namespace prowl

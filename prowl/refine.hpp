#pragma once

#include <functional>

#include "prowl/certificate/mesh_errors.hpp"
#include "prowl/plan.hpp"

namespace prowl {

/// One mesh and what came of it.
struct RefineRound {
  int intervals = 0;
  int iterations = 0;
  MeshTolerance errors;  ///< the worst
  int too_coarse = 0;    ///< intervals that are off by more than the tolerance
};

struct RefineOptions {
  MeshTolerance tolerance;
  int max_rounds = 12;                                    ///< meshes solved, the first one too
  std::function<void(const RefineRound&)> on_round = {};  ///< after each mesh that converged; may be empty
};

struct RefinedPlan {
  Plan plan;
  bool meets_tolerance = false;  ///< if not, a hint of the plan tells why
  bool interrupted = false;      ///< before the refinement was at its end; the plan may be a good one all the same
};

/// As make_plan(), on meshes that follow the errors measured on the one before (mesh_refinement.hpp): from the coarsest
/// on which make_plan() would begin, until the motion meets the tolerance and a mesh without what it has to spare would
/// have more than four fifths of its intervals. Each motion is the guess of the next. PlanOptions::max_seconds is for
/// all together, certificates too: no mesh is begun after it.
///
/// The result is of the mesh with the fewest intervals among those that meet the tolerance, the ones that pass their
/// certificate first, else of the one that is nearest to the tolerance. A mesh that does not converge ends it, and so
/// does an interrupt.
RefinedPlan make_refined_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options,
                              const RefineOptions& refine);

}  // namespace prowl

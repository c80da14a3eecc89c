#pragma once

#include <functional>
#include <string>
#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl {

/// How one mesh was solved on the way to the last.
struct LevelResult {
  int intervals = 0;
  SolveStatus status = SolveStatus::solver_failed;
  int iterations = 0;
  double seconds = 0.0, cpu_seconds = 0.0;
};

/// What comes out: a motion, how it was found, and whether it is any good.
struct Plan {
  Trajectory trajectory;
  Mesh mesh;           ///< of the trajectory: the one asked for, or where the solve was stopped, a coarser one
  std::string solver;  ///< its name
  HessianKind hessian = HessianKind::exact;  ///< second derivatives that it was given
  /// Of the last level; iterations and seconds of all levels together. Where an interrupt or the time limit stopped a
  /// coarse level, that is the last, and the motion is on its mesh.
  SolveResult result;
  std::vector<LevelResult> levels;
  Certificate certificate;
  int num_variables = 0;
  int num_constraints = 0;
  /// Why there can be no such motion, proven before the solve (proofs_of_infeasibility). If there is a reason the
  /// status is infeasible, the solver did not run, and the trajectory is the initial guess.
  std::vector<std::string> reasons;
  /// What may be the matter with a motion that fails its certificate: doubts, or, if the solve converged, singular
  /// postures (postures_that_lose_rank). None if it was interrupted.
  std::vector<std::string> hints;
};

/// Whether the plan may be used: the solver converged and the certificate passed.
inline bool is_good(const Plan& plan) {
  return plan.result.status == SolveStatus::converged && plan.certificate.passed;
}

struct PlanOptions {
  SolverOptions solver;  ///< max_iterations is for each level, max_seconds for all together
  /// Empty: start from the task alone, on a coarse mesh first. Else start from this motion (see resample()).
  Trajectory start_from = {};
  /// start_from is an iterate of this problem, where a solve was stopped (Checkpoint): go on with its mesh, then with
  /// the finer ones, and as from any guess. Else it is taken for a solution of a neighbouring problem, which the next
  /// is near to.
  bool resume = false;
  /// Of the plan whose motion that is (Plan::result.stage_multipliers), if at hand and the mesh is the same.
  /// Sizes that do not fit are left out.
  std::vector<StageMultipliers> start_multipliers = {};
  /// For the small programs behind the hints after a failure, which are no chains of stages. Called after a failure
  /// only, for it may load a library; empty or nullptr: the solver of the plan.
  std::function<const NlpSolver*()> hint_solver = {};
  HessianKind hessian = HessianKind::exact;
  bool coarse_first = true;                          ///< false: on the mesh asked for at once
  std::function<void(int intervals)> on_level = {};  ///< called before a mesh is solved; may be empty
  /// Each iterate as the plan that it would be if the solve were interrupted there, but without certificate and times
  /// of evaluations. Costs an evaluation of all values; may be empty.
  std::function<void(Plan iterate)> on_iterate = {};
};

/// Whether a finer mesh may start from where this solve stopped; after a failure it starts from the task again.
bool is_worth_going_on_from(SolveStatus status);

/// The whole way from a problem to a certified motion. Throws InputError if bounds contradict each other or the motion
/// to start from makes no sense, NumericalError if the model cannot be evaluated at the initial guess; a problem that
/// is too hard is a status in the result.
Plan make_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options);

}  // namespace prowl

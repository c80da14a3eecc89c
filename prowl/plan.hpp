#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl {

/// Result of the solve on one mesh.
struct LevelResult {
  int intervals = 0;
  SolveStatus status = SolveStatus::solver_failed;
  int iterations = 0;
  double seconds = 0.0, cpu_seconds = 0.0;
};

/// A motion with its solver's result and its certificate.
struct Plan {
  Trajectory trajectory;
  Mesh mesh;           ///< of the trajectory: the requested one, or a coarser one if the solve was stopped
  std::string solver;  ///< its name
  HessianKind hessian = HessianKind::exact;  ///< second derivatives given to the solver
  /// Result of the last level, but iterations, seconds and times of all levels together. If an interrupt or the time
  /// limit stopped a coarse level, that is the last, and the motion is on its mesh.
  SolveResult result;
  std::vector<LevelResult> levels;
  Certificate certificate;
  int num_variables = 0;
  int num_constraints = 0;
  /// Proofs before the solve that there is no motion (proofs_of_infeasibility). With a reason, the status is
  /// infeasible, the solver did not run, and the trajectory is the initial guess.
  std::vector<std::string> reasons;
  /// Possible causes if the motion fails its certificate: the limits that restore() found in conflict and doubts() or,
  /// if the solve converged, postures_that_lose_rank(). None after an interrupt.
  std::vector<std::string> hints;
};

/// True if the solver converged and the certificate passed.
inline bool is_good(const Plan& plan) {
  return plan.result.status == SolveStatus::converged && plan.certificate.passed;
}

struct PlanOptions {
  SolverOptions solver;  ///< max_iterations is for each level, max_seconds for all together
  /// Motion to start from (see resample()); empty: start from the task alone, on a coarse mesh first.
  Trajectory warm_start = {};
  /// True: warm_start is an iterate of a stopped solve of this problem (Checkpoint). Continue on its mesh, then on
  /// finer ones, as from any guess. False: it solves a neighbouring problem, and the solution is near it.
  bool resume = false;
  /// Multipliers of the plan with that motion (Plan::result.stage_multipliers), if known and on the same mesh. Sizes
  /// that do not fit are left out.
  std::vector<StageMultipliers> warm_start_multipliers = {};
  /// Returns the solver for programs that are not chains of stages: restore(), and those behind the hints. Called only
  /// after a failure, because it may load a library. Empty, or nullptr returned: nothing is restored, and the solver of
  /// the plan serves for the hints.
  std::function<const NlpSolver*()> elastic_solver = {};
  HessianKind hessian = HessianKind::exact;
  /// Adds deferred_corrections() along warm_start: the motion becomes one of fourth order, with cubics between nodes.
  bool corrected = false;
  bool coarse_first = true;                          ///< false: only on the requested mesh
  std::function<void(int intervals)> on_level = {};  ///< called before a mesh is solved; may be empty
  /// Receives each iterate as the plan of a solve interrupted there, without certificate and times of evaluations.
  /// Costs an evaluation of all values; may be empty.
  std::function<void(Plan iterate)> on_iterate = {};
};

/// True after an interrupt or the time limit: no finer mesh is begun, its first iterates are worse to resume.
bool is_stopped(SolveStatus status);
/// True if the solver ended by itself without a solution.
bool has_failed(SolveStatus status);

/// True if a finer mesh may start from the result of this solve; after a failure it starts from the task again.
bool is_worth_going_on_from(SolveStatus status);

/// The steps of make_plan(): a motion without certificate and hints; after a failure, what is between it and a motion;
/// certificate and hints. `asked` may have another mesh than the plan.
Plan solve_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options);
/// After a solve that failed, of `asked` or on a finer mesh: solves `asked` elastically, all limits together. A motion
/// that needs no limit to give way is returned, to solve from again. Else the status becomes infeasible, and the hints
/// name the limits that give way. Neither after a limit of iterations, if the elastic solve does not converge, or
/// without a solver for it.
std::optional<Trajectory> restore(const DiscreteProblem& asked, const PlanOptions& options, Plan& plan);
void judge(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options, Plan& plan);

/// Plans a motion and certifies it. Throws InputError if bounds contradict each other or warm_start does not fit,
/// NumericalError if the model cannot be evaluated at the initial guess. A hard problem gives a status in the result.
Plan make_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options);

}  // namespace prowl

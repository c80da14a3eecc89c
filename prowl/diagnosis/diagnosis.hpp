#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/elastic/elastic_solve.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// A change of one number that makes the task solvable.
struct ProposedChange {
  std::string
      kind;  ///< "friction", "torque", "joint_position", "joint_velocity", "goal", "place", "clearance", "duration"
  int phase = -1;          ///< -1 for the whole motion
  std::string subject;     ///< surface, joints, goal, contact or phase; "" for all
  bool is_factor = false;  ///< `to` is a common factor on the limits of several joints; `from` is 1
  double from = 0.0, to = 0.0;
  std::string unit;
  std::string from_words,
      to_words;         ///< the same as in a file, with unit, if these differ: "[-2.44, -0.97] rad"
  std::string besides;  ///< its side effects, "" if none: "the whole goal 0.6 times as far"
  double amount = 0.0;  ///< |log(to / from)|, or the parameter's amount if `from` is 0
  /// Solved on the task's own mesh, and its certificate passes or fails by that mesh alone. Otherwise solved on the
  /// search mesh only.
  bool is_proved = false;
  bool passes = false;     ///< proved, and passes the whole certificate
  bool was_tried = false;  ///< on the task's own mesh, without a stop by time or iterations
};

/// Why a task has no plan.
struct Diagnosis {
  int task_intervals = 0;       ///< of the task's mesh
  bool solvable = false;        ///< the unchanged task has a plan
  Certificate certificate;      ///< of that plan
  bool needs_one_mesh = false;  ///< make_plan finds that plan only with PlanOptions::coarse_first = false
  /// Reason why make_plan of the unchanged task was stopped (time, iterations, interrupt); "" if it was not.
  std::string stopped_by;
  bool is_undecided() const { return !solvable && !stopped_by.empty(); }
  /// From make_plan of the unchanged task. If not converged but solvable, the task's mesh was solved from the initial
  /// guess.
  SolveStatus status = SolveStatus::solver_failed;
  std::string message;               ///< the solver's
  std::vector<std::string> reasons;  ///< proofs_of_infeasibility()
  std::vector<std::string> hints;    ///< Plan::hints; with a proof, doubts()
  /// Empty from here on if the task has a plan, unless that was found late and fails its certificate by more than its
  /// mesh. kind, phase and subject name the cause: the smallest change, with all joints together; if it fails on the
  /// task's mesh, the change that holds there; without a change, the limit that gives way most; else nothing.
  std::string kind;
  int phase = -1;
  std::string subject;
  SolveStatus elastic_status = SolveStatus::solver_failed;  ///< of the solve behind the breaches
  std::vector<Breach> breaches;         ///< worst first; of limits of that kind alone if they suffice, else of all
  int search_intervals = 0;             ///< of the mesh of breaches and changes; 0: each mesh of the task was solved
  std::vector<ProposedChange> changes;  ///< alternatives: the proved one, then smallest first; the first one turns only
                                        ///< the joints that gave way, if these suffice
  int tried = 0;                        ///< numbers that were changed
  bool out_of_time = false;             ///< before everything was tried
  bool interrupted = false;             ///< likewise
};

/// True if all checks pass except errors of the mesh, and these are small enough that a finer mesh keeps the motion.
bool holds_but_for_its_mesh(const Certificate& certificate);

struct DiagnosisOptions {
  SolverOptions solver;                                  ///< tolerance, threads, interrupt
  double max_seconds = 120.0;                            ///< in all
  std::function<void(const std::string&)> on_step = {};  ///< receives one line per step
};

/// Diagnoses a task:
/// 1. Look for proofs. Solve the task on its meshes, from about 20 intervals up, until `solver` finds no motion. Plan
///    the unchanged task (make_plan), which may still succeed. If all meshes are solved, nothing has to change.
/// 2. On the mesh without a motion, bisect the least amount of each parameter (adjustable_parameters) with which
///    `solver` converges. Parameters that cannot be the smallest end after one solve.
/// 3. Solve elastically with `elastic_solver` and limits of the named kind: where, when, by how much they give way.
/// 4. Narrow joints down to those that gave way, if these suffice.
/// 5. Plan the task with each of the smallest changes on its own mesh, up to the first that passes its certificate or
///    fails by that mesh alone.
/// 6. If time ran out for the unchanged task in step 1, resume it with the remaining time.
Diagnosis diagnose(const DiscreteProblem& problem, const NlpSolver& solver, const NlpSolver& elastic_solver,
                   const DiagnosisOptions& options);

}  // namespace prowl

#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/certificate/certificate.hpp"
#include "prowl/diagnosis/elastic_solve.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"

namespace prowl {

/// A change of one number with which the task was solved.
struct Change {
  std::string
      kind;  ///< "friction", "torque", "joint_position", "joint_velocity", "goal", "place", "clearance", "duration"
  int phase = -1;       ///< -1: not of one phase
  std::string subject;  ///< surface, joints, goal, contact or phase; "" for all
  bool is_factor =
      false;  ///< `to` is what the limits of several joints, which may differ, are multiplied with; `from` is 1
  double from = 0.0, to = 0.0;
  std::string unit;
  std::string from_words,
      to_words;         ///< the same in the terms of a file where these are others, with unit: "[-2.44, -0.97] rad"
  std::string besides;  ///< what changes with it, "" if nothing: "all that it asks for 0.6 times as far"
  double amount = 0.0;  ///< |log(to / from)|, or of a number that is 0 how far it was turned: how changes of different
                        ///< numbers are compared
  /// Solved on the task's own mesh, and what of its certificate fails is the error of that mesh; else solved on the
  /// mesh of the search, and no more.
  bool is_proved = false;
  bool passes = false;     ///< that, and the whole certificate
  bool was_tried = false;  ///< on the task's own mesh, and no limit of time or iterations ended that; if it is not
                           ///< proved, without success
};

/// Why a task has no plan, as far as can be found out.
struct Diagnosis {
  int task_intervals = 0;       ///< of the mesh of the task
  bool solvable = false;        ///< the task as it is has a plan
  Certificate certificate;      ///< of that plan
  bool needs_one_mesh = false;  ///< make_plan finds that plan on the task's mesh at once (PlanOptions::coarse_first
                                ///< false), not by way of coarse ones
  /// What stopped make_plan of the task as it is before its end, in words: time, iterations, an interrupt. "" if
  /// nothing did.
  std::string stopped_by;
  bool is_undecided() const { return !solvable && !stopped_by.empty(); }
  /// Of make_plan of the task as it is. Not converged, and yet solvable: the task's mesh was solved from the initial
  /// guess.
  SolveStatus status = SolveStatus::solver_failed;
  std::string message;               ///< the solver's
  std::vector<std::string> reasons;  ///< proofs_of_infeasibility()
  std::vector<std::string> hints;    ///< Plan::hints; doubts() besides a proof
  /// From here on empty if the task has a plan, unless that was found late and fails its certificate by more than its
  /// mesh. What is named: what the change turns that is smallest while joints are turned all together; if that did not
  /// hold on the task's mesh, the one that did; if no change was found, the limit that gives way most. Empty if
  /// neither.
  std::string kind;
  int phase = -1;
  std::string subject;
  SolveStatus elastic_status = SolveStatus::solver_failed;  ///< of the solve that the breaches are from
  std::vector<Breach>
      breaches;                 ///< of the limits of that kind alone if they suffice, else of all together; worst first
  int search_intervals = 0;     ///< of the mesh that breaches and changes are from; 0: each mesh of the task was solved
  std::vector<Change> changes;  ///< each by itself; the one that is proved, then smallest first; of joints, in the one
                                ///< named first, those that gave way if they are enough
  int tried = 0;                ///< numbers that were turned
  bool out_of_time = false;     ///< before all was tried that could have been
  bool interrupted = false;     ///< likewise
};

/// Whether all checks pass but for errors of the mesh, and those not by so much that on a finer one it would be another
/// motion.
bool holds_but_for_its_mesh(const Certificate& certificate);

struct DiagnosisOptions {
  SolverOptions solver;                                  ///< tolerance, threads, interrupt
  double max_seconds = 120.0;                            ///< in all
  std::function<void(const std::string&)> on_step = {};  ///< told what is being done, one line
};

/// Diagnoses a task:
/// 1. proofs before the solve; then the meshes of the task, a search mesh of about 20 intervals first, up to one on
/// which
///    `solver` finds no motion; and the task as it is (make_plan), which may succeed all the same. If all meshes were
///    solved, there is a motion and nothing to change, whatever became of that plan;
/// 2. on that mesh, for each number that the task could have otherwise (knobs_of) by bisection the least change with
///    which `solver` converges; kinds that cannot be the smallest any more are left after one solve;
/// 3. an elastic solve by `elastic_solver` with the limits of the kind that was named, to read where, when and by how
///    much;
/// 4. joints are narrowed down to those that gave way, if these alone suffice;
/// 5. the task with each of the smallest changes on its own mesh, up to the first that passes its certificate, or fails
/// it by that mesh alone;
/// 6. what is left of the time for the task as it is, if the time was up for it in step 1.
Diagnosis diagnose(const DiscreteProblem& problem, const NlpSolver& solver, const NlpSolver& elastic_solver,
                   const DiagnosisOptions& options);

}  // namespace prowl

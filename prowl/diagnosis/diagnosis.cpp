#include "prowl/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "prowl/diagnosis/change_search.hpp"
#include "prowl/diagnosis/search_mesh.hpp"
#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/plan.hpp"
#include "prowl/transcription/initial_guess.hpp"
#include "prowl/transcription/mesh.hpp"
#include "prowl/transcription/mesh_levels.hpp"

namespace prowl {

namespace {

/// Of the time that is left, what an elastic solve may take: it is an explanation, and the changes are the answer.
constexpr double kElasticPart = 0.5;
constexpr double kSearchPart = 0.65;  // of the time that is left, for the search
constexpr double kOwnPart = 0.1;  // of the time, for the task as it is: who asks knows that it has no plan
constexpr int kElasticIterations = 500;
constexpr double kElasticTolerance = 1e-5;  // a tenth of a thousandth of a weight or a limit

bool is_of_joints(const std::string& kind) {
  return kind == "torque" || kind == "joint_velocity" || kind == "joint_position";
}

/// What a breach of a joint's limit adds to; of a range, which widens on both sides, half of it.
double limit_of_joint(const RobotModel& robot, LimitKind kind, int joint) {
  if (kind == LimitKind::torque) return robot.torque_limit()(joint);
  if (kind == LimitKind::joint_velocity) return robot.velocity_limit()(joint);
  return 0.5 * (robot.position_upper()(joint) - robot.position_lower()(joint));
}

Change as_change(const FoundChange& found) {
  return {found.knob.kind, found.knob.phase, found.knob.subject, found.knob.value(0.0), found.knob.value(found.amount),
          found.knob.unit, found.amount};
}

class Diagnoser {
 public:
  Diagnoser(const MotionProblem& problem, const NlpSolver& solver, const NlpSolver& elastic,
            const DiagnosisOptions& options)
      : problem_(problem),
        solver_(solver),
        elastic_(elastic),
        options_(options),
        search_(solver, options.solver, options.max_seconds) {}

  Diagnosis run() {
    result_.reasons = proofs_of_infeasibility(problem_);
    if (find_failing_mesh() && solve_as_it_is()) return result_;
    if (search_.interrupted()) return result_;
    step("postures of the initial guess");
    result_.hints = doubts(problem_, initial_guess(problem_, make_mesh(problem_)), elastic_);
    const std::vector<Knob> knobs = knobs_of(coarse_);
    result_.tried = static_cast<int>(knobs.size());
    std::vector<FoundChange> found = search_.smallest(knobs, kSearchPart * search_.seconds_left(),
                                                      [&](const std::string& what) { step("trying " + what); });
    name(found);
    narrow_down(found);
    for (const FoundChange& change : found) result_.changes.push_back(as_change(change));
    if (!found.empty()) prove(found.front());
    result_.out_of_time = search_.seconds_left() <= 0.0;
    return result_;
  }

 private:
  void step(const std::string& what) const {
    if (options_.on_step) options_.on_step(what);
  }

  /// The coarsest mesh on which there is no solution: it costs least to look for changes there. The task's own if there
  /// is none. False if a proof makes it pointless to solve the task as it is.
  bool find_failing_mesh() {
    coarse_ = on_search_mesh(problem_);
    if (!result_.reasons.empty()) {
      result_.status = SolveStatus::infeasible;
      return false;
    }
    std::vector<MotionProblem> levels = mesh_levels(problem_);
    if (count_intervals(coarse_) < count_intervals(problem_)) levels.insert(levels.begin(), coarse_);
    for (MotionProblem& level : levels) {
      coarse_ = std::move(level);
      step(fmt::format("solving as it is, {} intervals", count_intervals(coarse_)));
      if (!search_.solves(coarse_)) break;
    }
    return true;
  }

  /// As prowl plan does; true if there is a plan.
  bool solve_as_it_is() {
    step("planning as it is");
    PlanOptions options{.solver = options_.solver};
    options.hint_solver = &elastic_;
    options.solver.max_seconds = search_.seconds_of_solve(kOwnPart, options.solver.max_seconds);
    const Plan plan = make_plan(problem_, solver_, options);
    result_.status = plan.result.status;
    result_.message = plan.result.message;
    result_.solvable = plan.result.status == SolveStatus::converged;
    if (!result_.solvable) return false;
    result_.certificate = plan.certificate;
    result_.hints = plan.hints;
    return true;
  }

  /// Reads where the limits give way of the kind that is to be changed; of all kinds if nothing is found to change, or
  /// if it is the time, or if that kind alone does not do.
  void name(const std::vector<FoundChange>& found) {
    if (!found.empty()) {
      const Knob& knob = found.front().knob;
      result_.kind = knob.kind;
      result_.phase = knob.phase;
      result_.subject = knob.subject;
      if (knob.kind != "duration") read_breaches(knob.kind);
    }
    if (result_.breaches.empty()) read_breaches("");
    if (!found.empty() || result_.breaches.empty()) return;
    const Breach& worst = result_.breaches.front();
    result_.kind = to_string(worst.kind);
    result_.phase = worst.phase;
    result_.subject = worst.subject;
  }

  void read_breaches(const std::string& kind) {
    if (!search_.may_go_on()) return;
    step(kind.empty() ? "elastic solve, all limits" : "elastic solve, " + kind);
    SolverOptions options = options_.solver;
    options.tolerance = std::max(options.tolerance, kElasticTolerance);
    options.max_iterations = kElasticIterations;
    options.max_seconds = search_.seconds_of_solve(kElasticPart);
    try {
      const ElasticResult elastic = elastic_solve(coarse_, elastic_, options, [&](const MotionLimit& limit) {
        return kind.empty() || kind == to_string(limit.kind);
      });
      result_.elastic_status = elastic.status;
      if (elastic.status == SolveStatus::converged) result_.breaches = elastic.breaches;
    } catch (const Error&) {  // bounds that contradict each other: nothing to give way
      result_.elastic_status = SolveStatus::evaluation_failed;
    }
  }

  /// Joints that gave way are named, if no other has to.
  void narrow_down(std::vector<FoundChange>& found) {
    if (found.empty() || !is_of_joints(found.front().knob.kind)) return;
    FoundChange& smallest = found.front();
    const std::vector<std::string>& names = coarse_.robot.joint_names();
    std::set<int> joints;
    double needed = 0.0;  // amount that brings each of them as far as the elastic solution went
    for (const Breach& breach : result_.breaches) {
      if (to_string(breach.kind) != smallest.knob.kind) continue;
      const int joint = static_cast<int>(std::ranges::find(names, breach.subject) - names.begin());
      joints.insert(joint);
      needed = std::max(needed, std::log1p(breach.amount / limit_of_joint(coarse_.robot, breach.kind, joint)));
    }
    if (joints.empty() || static_cast<int>(joints.size()) == coarse_.robot.nu()) return;
    const Knob some = joint_knob(coarse_, smallest.knob.kind, {joints.begin(), joints.end()});
    constexpr double kALittleMore = 0.1;  // a solution has room, an elastic one none
    step("trying " + some.subject);
    for (const double amount : {smallest.amount, needed + kALittleMore, needed + 4.0 * kALittleMore}) {
      if (amount < smallest.amount || !search_.solves(some, amount)) continue;
      smallest = {some, amount};
      result_.subject = some.subject;
      return;
    }
  }

  /// The same change on the mesh of the task, the whole way to the certificate; a little more of it if need be.
  void prove(FoundChange& found) {
    for (const double more : {0.0, 0.05, 0.15}) {
      if (!search_.may_go_on()) return;
      const double amount = found.amount + more;
      step(fmt::format("the smallest change on the mesh of the task, {:.3g} {}", found.knob.value(amount), found.knob.unit));
      try {
        PlanOptions options{.solver = options_.solver};
        options.hint_solver = &elastic_;
        options.solver.max_seconds = search_.seconds_of_solve(1.0, options.solver.max_seconds);
        const Plan plan = make_plan(with_steps_of(found.knob.problem(amount), problem_), solver_, options);
        if (plan.result.status != SolveStatus::converged || !plan.certificate.passed) continue;
      } catch (const Error&) {
        continue;
      }
      found.amount = amount;
      result_.changes.front() = as_change(found);
      result_.changes.front().on_the_task_mesh = true;
      return;
    }
  }

  const MotionProblem& problem_;
  const NlpSolver& solver_;
  const NlpSolver& elastic_;
  const DiagnosisOptions& options_;
  ChangeSearch search_;
  MotionProblem coarse_ = problem_;
  Diagnosis result_;
};

}  // namespace

Diagnosis diagnose(const MotionProblem& problem, const NlpSolver& solver, const NlpSolver& elastic_solver,
                   const DiagnosisOptions& options) {
  validate(problem);
  return Diagnoser(problem, solver, elastic_solver, options).run();
}

}  // namespace prowl

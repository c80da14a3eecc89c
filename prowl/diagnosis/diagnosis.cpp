#include "prowl/diagnosis/diagnosis.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>

#include "prowl/diagnosis/change_search.hpp"
#include "prowl/diagnosis/joint_knobs.hpp"
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
constexpr double kOwnPart = 0.2;  // of the time, for a task that has no solution on one of its meshes; more, once the search is over
constexpr int kElasticIterations = 500;
constexpr double kElasticTolerance = 1e-5;  // of a weight or a limit

bool is_of_joints(LimitKind kind) {
  return kind == LimitKind::torque || kind == LimitKind::joint_velocity || kind == LimitKind::joint_position;
}

Change as_change(const FoundChange& found) {
  const Knob& knob = found.knob;
  const auto words = [&](double amount) { return knob.words ? knob.words(amount) : std::string(); };
  const double from = knob.value(0.0), to = knob.value(found.amount), ratio = std::abs(std::log(to / from));
  return {.kind = knob.kind, .phase = knob.phase, .subject = knob.subject, .is_factor = knob.is_factor, .from = from, .to = to,
          .unit = knob.unit, .from_words = words(0.0), .to_words = words(found.amount),
          .besides = knob.besides ? knob.besides(found.amount) : "", .amount = std::isfinite(ratio) ? ratio : found.amount};
}

/// What became of a change on the mesh of the task.
struct Proof {
  std::optional<Certificate> certificate;  ///< of its motion, if that holds but for the error of its mesh
  bool was_tried = false;                  ///< nothing ended that early
};

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
    if (!result_.reasons.empty()) {
      result_.status = SolveStatus::infeasible;
      look_for_changes();
    } else if (const std::optional<Trajectory> motion = solve_all_meshes()) {
      plan_as_it_is(1.0);
      if (!result_.solvable) take_from_own_mesh(*motion);
    } else {
      plan_as_it_is(kOwnPart);
      if (!result_.solvable) look_for_changes();
      if (result_.status == SolveStatus::time_limit) go_on_as_it_is();
    }
    result_.interrupted = search_.interrupted();
    if (!result_.solvable && search_.seconds_left() <= 0.0) result_.out_of_time = true;
    return result_;
  }

 private:
  void step(const std::string& what) const {
    if (options_.on_step) options_.on_step(what);
  }

  /// The motion on the task's own mesh, if there is one on the search mesh, on all finer ones of the task and on that. Else
  /// `searched_` is on the coarsest without: there it costs least to look for changes. Feet may drift on coarse ones: a finer
  /// one will tell.
  std::optional<Trajectory> solve_all_meshes() {
    std::vector<MotionProblem> meshes{searched_};
    for (MotionProblem& level : mesh_levels(problem_)) {
      if (count_intervals(level) > count_intervals(meshes.front())) meshes.push_back(std::move(level));
    }
    std::optional<Trajectory> motion;
    for (MotionProblem& mesh : meshes) {
      searched_ = std::move(mesh);
      step(fmt::format("solving as it is, {} intervals", count_intervals(searched_)));
      motion = search_.motion(searched_);
      if (!motion) break;
    }
    return motion;
  }

  /// As prowl plan does, in a part of the time that is left, of which so much was spent on it before.
  Plan planned(const MotionProblem& problem, double part, PlanOptions options = {}, double seconds_before = 0.0) const {
    options.solver = options_.solver;
    options.hint_solver = &elastic_;
    options.solver.max_seconds = search_.seconds_of_solve(part, options.solver.max_seconds - seconds_before);
    return make_plan(problem, solver_, options);
  }

  void plan_as_it_is(double part) {
    step("planning as it is");
    as_it_is_ = planned(problem_, part);
    judge_as_it_is();
  }

  void go_on_as_it_is() {
    if (!search_.may_go_on() || as_it_is_.result.seconds >= options_.solver.max_seconds) return;
    step("planning as it is, from where it was stopped");
    const double seconds_before = as_it_is_.result.seconds;
    PlanOptions options;
    options.resume = !as_it_is_.trajectory.empty();
    options.start_from = std::move(as_it_is_.trajectory);
    as_it_is_ = planned(problem_, 1.0, std::move(options), seconds_before);
    as_it_is_.result.seconds += seconds_before;
    // What was found meanwhile is of no use, unless this is a motion that only its mesh allows.
    if (as_it_is_.result.status == SolveStatus::converged && holds_but_for_its_mesh(as_it_is_.certificate)) result_ = {};
    judge_as_it_is();
  }

  /// prowl plan did not get there, but the task's own mesh was solved from the initial guess.
  void take_from_own_mesh(const Trajectory& motion) {
    result_.solvable = true;
    result_.certificate = certify(problem_, motion);
    const bool has_coarse_meshes = mesh_levels(problem_).size() > 1;
    if (!result_.stopped_by.empty() || !has_coarse_meshes || !search_.may_go_on()) return;
    step("planning as it is, on its own mesh at once");
    PlanOptions options;
    options.coarse_first = false;
    Plan plan = planned(problem_, 1.0, std::move(options));
    if (plan.result.status != SolveStatus::converged) return;
    result_.needs_one_mesh = true;
    result_.certificate = std::move(plan.certificate);
    result_.hints = std::move(plan.hints);
  }

  void judge_as_it_is() {
    result_.status = as_it_is_.result.status;
    result_.message = as_it_is_.result.message;
    result_.solvable = result_.status == SolveStatus::converged;
    result_.stopped_by = what_stopped(as_it_is_.result);
    if (!result_.solvable) return;
    result_.certificate = as_it_is_.certificate;
    result_.hints = as_it_is_.hints;
  }

  std::string what_stopped(const SolveResult& plan) const {
    if (plan.status == SolveStatus::interrupted) return "interrupted";
    if (plan.status == SolveStatus::iteration_limit) {
      return fmt::format("stopped after its solver.max_iterations ({})", options_.solver.max_iterations);
    }
    if (plan.status != SolveStatus::time_limit) return "";
    return plan.seconds >= options_.solver.max_seconds
               ? fmt::format("stopped after its solver.max_time_s ({:g} s)", options_.solver.max_seconds)
               : fmt::format("the time was up after {:.1f} s of planning it", plan.seconds);
  }

  void look_for_changes() {
    result_.search_intervals = count_intervals(searched_);
    step("postures of the initial guess");
    result_.hints = doubts(problem_, initial_guess(problem_, make_mesh(problem_)), elastic_);
    ChangesFound changes = search_.within(kSearchPart).smallest(knobs_of(searched_), [&](const std::string& what) { step("trying " + what); });
    std::vector<FoundChange>& found = changes.found;
    result_.tried = changes.tried;
    name(found);
    narrow_down(found);
    for (const FoundChange& change : found) result_.changes.push_back(as_change(change));
    prove(found);
    result_.out_of_time = changes.out_of_time;
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
      const ElasticResult elastic = elastic_solve(searched_, elastic_, options, [&](const MotionLimit& limit) {
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
    if (found.empty()) return;
    FoundChange& smallest = found.front();
    const std::vector<std::string>& names = searched_.robot.joint_names();
    LimitKind kind = LimitKind::friction;
    std::set<int> joints;
    std::vector<int> turnable;
    double needed = 0.0;  // amount that brings each of them as far as the elastic solution went
    for (const Breach& breach : result_.breaches) {
      if (!is_of_joints(breach.kind) || to_string(breach.kind) != smallest.knob.kind) continue;
      kind = breach.kind;
      const int joint = static_cast<int>(std::ranges::find(names, breach.subject) - names.begin());
      if (turnable.empty()) turnable = turnable_joints(searched_.robot, kind);
      if (std::ranges::find(turnable, joint) == turnable.end()) return;  // these alone cannot do
      joints.insert(joint);
      const double sides = breach.kind == LimitKind::joint_position ? 2.0 : 1.0;  // on which the limit yields
      needed = std::max(needed, std::log1p(sides * breach.amount / value_of_limit(searched_.robot, breach.kind, joint)));
    }
    if (joints.empty() || static_cast<int>(joints.size()) == searched_.robot.nu()) return;
    const Knob some = joint_knob(searched_, kind, {joints.begin(), joints.end()});
    constexpr double kALittleMore = 0.1;  // a solution has room, an elastic one none
    step("trying " + some.subject);
    double last = 0.0;
    for (const double amount : {smallest.amount, needed + kALittleMore, needed + 4.0 * kALittleMore}) {
      const double turned = printable_amount(some, std::clamp(amount, smallest.amount, some.most));
      if (turned == last) continue;
      last = turned;
      if (!search_.solves(some, turned)) continue;
      smallest = {some, turned};
      result_.subject = some.subject;
      // Of fewer joints more may be needed than of something else.
      std::ranges::stable_sort(found, std::less(), &FoundChange::weighted);
      return;
    }
  }

  /// Up to the first that holds: with that one there is something to go on with.
  void prove(std::vector<FoundChange>& found) {
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i) {
      const Proof proof = proof_of(found[i]);
      result_.changes[i].was_tried = proof.was_tried;
      if (!proof.certificate) continue;
      Change proved = as_change(found[i]);
      proved.is_proved = proved.was_tried = true;
      proved.passes = proof.certificate->passed;
      result_.changes[i] = std::move(proved);
      const auto place = static_cast<std::ptrdiff_t>(i);
      std::rotate(found.begin(), found.begin() + place, found.begin() + place + 1);
      std::rotate(result_.changes.begin(), result_.changes.begin() + place, result_.changes.begin() + place + 1);
      if (i > 0) {  // what was named first does not help
        result_.breaches.clear();
        name(found);
      }
      return;
    }
  }

  /// The same change, as it is told, on the mesh of the task, the whole way to the certificate; a little more of it if need be.
  Proof proof_of(FoundChange& found) const {
    double last = -1.0;
    bool was_tried = true;
    for (const double more : {0.0, 0.05, 0.15, 0.4}) {
      const double amount = printable_amount(found.knob, std::min(found.amount + more, found.knob.most));
      if (amount == last) break;
      if (!search_.may_go_on()) return {};
      last = amount;
      step(fmt::format("on the mesh of the task, {} {} {:.3g} {}", found.knob.kind, found.knob.subject, found.knob.value(amount), found.knob.unit));
      try {
        Plan plan = planned(with_steps_of(found.knob.problem(amount), problem_), 1.0);
        was_tried = was_tried && what_stopped(plan.result).empty();
        if (plan.result.status != SolveStatus::converged || !holds_but_for_its_mesh(plan.certificate)) continue;
        found.amount = amount;
        return {std::move(plan.certificate), true};
      } catch (const Error&) {  // bounds that contradict each other
        continue;
      }
    }
    return {{}, was_tried};
  }

  const MotionProblem& problem_;
  const NlpSolver& solver_;
  const NlpSolver& elastic_;
  const DiagnosisOptions& options_;
  ChangeSearch search_;
  MotionProblem searched_ = on_search_mesh(problem_);
  Plan as_it_is_;
  Diagnosis result_;
};

}  // namespace

bool holds_but_for_its_mesh(const Certificate& certificate) {
  constexpr double kMost = 100.0;  // times its limit: an error that five times the intervals would take away
  const auto is_near = [](const CertificateCheck& check) { return check.passed || check.worst <= kMost * check.limit; };
  return fails_by_mesh_only(certificate) && std::ranges::all_of(certificate.checks, is_near);
}

Diagnosis diagnose(const MotionProblem& problem, const NlpSolver& solver, const NlpSolver& elastic_solver,
                   const DiagnosisOptions& options) {
  validate(problem);
  return Diagnoser(problem, solver, elastic_solver, options).run();
}

}  // namespace prowl

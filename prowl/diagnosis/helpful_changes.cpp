#include "prowl/diagnosis/helpful_changes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "prowl/diagnosis/joint_parameters.hpp"
#include "prowl/elastic/elastic_solve.hpp"
#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/guess/initial_guess.hpp"

namespace prowl {

namespace {

constexpr double kElasticPart = 0.5;  // of the remaining time, for an elastic solve, which only explains the changes
constexpr double kSearchPart = 0.65;  // of the remaining time, for the search

bool is_of_joints(LimitKind kind) {
  return kind == LimitKind::torque || kind == LimitKind::joint_velocity || kind == LimitKind::joint_position;
}

ProposedChange as_change(const FoundChange& found) {
  const AdjustableParameter& parameter = found.parameter;
  const auto words = [&](double amount) { return parameter.words ? parameter.words(amount) : std::string(); };
  const double from = parameter.value(0.0), to = parameter.value(found.amount), ratio = std::abs(std::log(to / from));
  return {.kind = parameter.kind,
          .phase = parameter.phase,
          .subject = parameter.subject,
          .is_factor = parameter.is_factor,
          .from = from,
          .to = to,
          .unit = parameter.unit,
          .from_words = words(0.0),
          .to_words = words(found.amount),
          .besides = parameter.besides ? parameter.besides(found.amount) : "",
          .amount = std::isfinite(ratio) ? ratio : found.amount};
}

/// Result of a change on the mesh of the task.
struct Proof {
  std::optional<Certificate> certificate;  ///< of its motion, if only errors of the mesh fail
  bool was_tried = false;                  ///< without an early stop
};

class HelpfulChanges {
 public:
  explicit HelpfulChanges(DiagnosisRun& run) : run_(run) {}

  void run() {
    run_.result.search_intervals = run_.searched.mesh.num_intervals();
    if (!run_.result.reasons.empty() && run_.search.may_go_on()) {  // otherwise they are in the plan
      run_.step("checking postures of the initial guess");
      run_.result.hints = doubts(run_.problem, initial_guess(run_.problem), run_.elastic);
    }
    ChangesFound changes = run_.search.within(kSearchPart)
                               .smallest(adjustable_parameters(run_.searched.problem), run_.searched.mesh,
                                         [&](const std::string& what) { run_.step("trying " + what); });
    std::vector<FoundChange>& found = changes.found;
    run_.result.tried = changes.tried;
    name(found);
    narrow_down(found);
    for (const FoundChange& change : found) run_.result.changes.push_back(as_change(change));
    prove(found);
    run_.result.out_of_time = changes.out_of_time;
  }

 private:
  /// Names the cause and reads where limits of its kind give way; limits of all kinds if no change was found, if the
  /// cause is a duration, or if that kind alone does not suffice.
  void name(const std::vector<FoundChange>& found) {
    if (!found.empty()) {
      const AdjustableParameter& parameter = found.front().parameter;
      run_.result.kind = parameter.kind;
      run_.result.phase = parameter.phase;
      run_.result.subject = parameter.subject;
      if (parameter.kind != "duration") read_breaches(parameter.kind);
    }
    if (run_.result.breaches.empty()) read_breaches("");
    if (!found.empty() || run_.result.breaches.empty()) return;
    const Breach& worst = run_.result.breaches.front();
    run_.result.kind = to_string(worst.kind);
    run_.result.phase = worst.phase;
    run_.result.subject = worst.subject;
  }

  /// Names the change that helped in place of the first one. Keeps the breaches if there is no time for new ones.
  void rename(const std::vector<FoundChange>& found) {
    std::vector<Breach> before = std::exchange(run_.result.breaches, {});
    const SolveStatus status = run_.result.elastic_status;
    name(found);
    if (!run_.result.breaches.empty()) return;
    run_.result.breaches = std::move(before);
    run_.result.elastic_status = status;
  }

  void read_breaches(const std::string& kind) {
    if (!run_.search.may_go_on()) return;
    run_.step(kind.empty() ? "elastic solve, all limits" : "elastic solve, " + kind);
    SolverOptions options = run_.options.solver;
    options.max_seconds = run_.search.seconds_of_solve(kElasticPart);
    try {
      const ElasticResult elastic = elastic_solve(run_.searched, run_.elastic, options, [&](const MotionLimit& limit) {
        return kind.empty() || kind == to_string(limit.kind);
      });
      run_.result.elastic_status = elastic.status;
      if (elastic.status == SolveStatus::converged) run_.result.breaches = elastic.breaches;
    } catch (const Error&) {  // contradictory bounds: nothing can give way
      run_.result.elastic_status = SolveStatus::evaluation_failed;
    }
  }

  /// Restricts a change of all joints to those that gave way, if these suffice.
  void narrow_down(std::vector<FoundChange>& found) {
    if (found.empty()) return;
    FoundChange& smallest = found.front();
    const std::vector<std::string>& names = run_.searched.problem.robot.joint_names();
    LimitKind kind = LimitKind::friction;
    std::set<int> joints;
    std::vector<int> turnable;
    double needed = 0.0;  // amount that takes each of them as far as the elastic solution
    for (const Breach& breach : run_.result.breaches) {
      if (!is_of_joints(breach.kind) || to_string(breach.kind) != smallest.parameter.kind) continue;
      kind = breach.kind;
      const int joint = static_cast<int>(std::ranges::find(names, breach.subject) - names.begin());
      if (turnable.empty()) turnable = turnable_joints(run_.searched.problem.robot, kind);
      if (std::ranges::find(turnable, joint) == turnable.end()) return;  // the others do not suffice
      joints.insert(joint);
      const double sides = breach.kind == LimitKind::joint_position ? 2.0 : 1.0;  // a range widens on both sides
      needed = std::max(
          needed, std::log1p(sides * breach.amount / value_of_limit(run_.searched.problem.robot, breach.kind, joint)));
    }
    if (joints.empty() || static_cast<int>(joints.size()) == run_.searched.problem.robot.nu()) return;
    const AdjustableParameter some = joint_parameter(run_.searched.problem, kind, {joints.begin(), joints.end()});
    constexpr double kALittleMore = 0.1;  // an elastic solution is exactly at its limits
    run_.step("trying " + some.subject);
    double last = 0.0;
    for (const double amount : {smallest.amount, needed + kALittleMore, needed + 4.0 * kALittleMore}) {
      const double turned = printable_amount(some, std::clamp(amount, smallest.amount, some.most));
      if (turned == last) continue;
      last = turned;
      if (!run_.search.solves(some, turned, run_.searched.mesh)) continue;
      smallest = {some, turned};
      run_.result.subject = some.subject;
      // Fewer joints may need more than another parameter.
      std::ranges::stable_sort(found, std::less(), &FoundChange::weighted);
      return;
    }
  }

  /// Tries changes on the mesh of the task, up to the first that holds.
  void prove(std::vector<FoundChange>& found) {
    constexpr std::size_t kMost = 3;
    for (std::size_t i = 0; i < std::min(found.size(), kMost); ++i) {
      const Proof proof = proof_of(found[i]);
      run_.result.changes[i].was_tried = proof.was_tried;
      if (!proof.certificate) continue;
      ProposedChange proved = as_change(found[i]);
      proved.is_proved = proved.was_tried = true;
      proved.passes = proof.certificate->passed;
      run_.result.changes[i] = std::move(proved);
      const auto index = static_cast<std::ptrdiff_t>(i);
      std::rotate(found.begin(), found.begin() + index, found.begin() + index + 1);
      std::rotate(run_.result.changes.begin(), run_.result.changes.begin() + index,
                  run_.result.changes.begin() + index + 1);
      if (i > 0) rename(found);
      return;
    }
  }

  /// Plans the printed change on the mesh of the task, up to its certificate; turns it slightly further if needed.
  Proof proof_of(FoundChange& found) const {
    double last = -1.0;
    bool was_tried = true;
    for (const double more : {0.0, 0.05, 0.15, 0.4}) {
      const double amount = printable_amount(found.parameter, std::min(found.amount + more, found.parameter.most));
      if (amount == last) break;
      if (!run_.search.may_go_on()) return {};
      last = amount;
      run_.step("planning with " + in_words(found.parameter, amount));
      try {
        Plan plan = run_.planned({found.parameter.problem(amount), run_.problem.mesh}, 1.0);
        was_tried = was_tried && run_.what_stopped(plan.result).empty();
        if (plan.result.status != SolveStatus::converged || !holds_but_for_its_mesh(plan.certificate)) continue;
        found.amount = amount;
        return {std::move(plan.certificate), true};
      } catch (const Error&) {  // contradictory bounds
        continue;
      }
    }
    return {{}, was_tried};
  }

  DiagnosisRun& run_;
};

}  // namespace

void look_for_changes(DiagnosisRun& run) { HelpfulChanges(run).run(); }

}  // namespace prowl

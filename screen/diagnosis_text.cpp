#include "screen/diagnosis_text.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "prowl/elastic/breach.hpp"
#include "prowl/files/json_text.hpp"
#include "screen/mesh_advice.hpp"
#include "screen/plan_summary.hpp"

namespace prowl {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kMostBreaches = 6;  // that are shown as text

/// What a change turns: "friction of floor", "duration of phase 1", "goal 1, base z".
std::string what_it_turns(const ProposedChange& change, const MotionProblem& problem) {
  if (change.kind == "friction") return "friction of " + change.subject;
  if (change.kind == "duration") {
    return change.phase < 0 ? "duration of all phases together"
                            : "duration of " + phase_in_words(problem, change.phase);
  }
  if (change.kind == "goal") return change.subject;
  if (change.kind == "place")
    return fmt::format("step of {} in {}", change.subject, phase_in_words(problem, change.phase));
  if (change.kind == "clearance") return "swing clearance";
  const std::string limit = change.kind == "torque"           ? "torque limit"
                            : change.kind == "joint_velocity" ? "velocity limit"
                                                              : "position range";
  return fmt::format("{} of {}", limit, change.subject.empty() ? "all joints" : change.subject);
}

/// "friction of floor 0.61 instead of 0.52"; of several joints, whose limits may differ, the factor.
std::string in_words(const ProposedChange& change, const MotionProblem& problem) {
  const std::string besides = change.besides.empty() ? "" : ", " + change.besides;
  if (change.is_factor) return fmt::format("{} times {:.3g}{}", what_it_turns(change, problem), change.to, besides);
  const auto words = [&](const std::string& own, double value) {
    return own.empty() ? with_unit(value, change.unit) : own;
  };
  return fmt::format("{} {} instead of {}{}", what_it_turns(change, problem), words(change.to_words, change.to),
                     words(change.from_words, change.from), besides);
}

/// Before the first semicolon of the headline: why there is no plan, or that it is not known whether there is one.
std::string what_is_missing(const Diagnosis& diagnosis, const MotionProblem& problem) {
  std::string missing = diagnosis.breaches.empty() ? "" : in_words(diagnosis.breaches.front(), problem);
  if (missing.empty() && !diagnosis.reasons.empty()) missing = diagnosis.reasons.front();
  if (diagnosis.is_undecided()) {
    return "not known whether the task has a plan, " + diagnosis.stopped_by +
           (missing.empty() ? "" : fmt::format("; on {} mesh intervals {}", diagnosis.search_intervals, missing));
  }
  if (!missing.empty()) return missing;
  if (diagnosis.elastic_status == SolveStatus::converged) {
    return fmt::format(
        "not solved ({}), although no limit has to give way on {} mesh intervals: the solver may have missed a "
        "solution",
        diagnosis.message, diagnosis.search_intervals);
  }
  return fmt::format("not solved ({})", diagnosis.message);
}

/// After it: "solvable with friction of floor 0.61 instead of 0.52, perhaps with duration of phase 1 0.55 s instead of
/// 0.4 s". What was tried on the task's mesh and did not hold is for the text below.
std::string what_would_help(const Diagnosis& diagnosis, const MotionProblem& problem) {
  if (diagnosis.changes.empty()) {
    return diagnosis.out_of_time || diagnosis.interrupted ? "no change of one number was found in the time"
                                                          : "no change of one number was found that makes it solvable";
  }
  constexpr std::size_t kMostPerhaps = 2;
  std::vector<std::string> proved, perhaps;
  bool is_fine = true;
  for (const ProposedChange& change : diagnosis.changes) {
    if (change.is_proved || !change.was_tried)
      (change.is_proved ? proved : perhaps).push_back(in_words(change, problem));
    is_fine = is_fine && (change.passes || !change.is_proved);
  }
  perhaps.resize(std::min(perhaps.size(), kMostPerhaps));
  if (proved.empty() && perhaps.empty())
    return "no change of one number was found that makes it solvable on its own mesh";
  std::string help = proved.empty()
                         ? ""
                         : fmt::format("{} with {}", is_fine ? "solvable" : "solvable on a finer mesh (--refine)",
                                       fmt::join(proved, ", or "));
  if (perhaps.empty()) return help;
  return fmt::format("{} with {}", help.empty() ? "perhaps solvable" : help + ", perhaps", fmt::join(perhaps, ", or "));
}

/// Of a task that has a plan.
std::string how_it_is_found(const Diagnosis& diagnosis) {
  if (diagnosis.needs_one_mesh)
    return "the task has a plan with prowl plan --one-mesh, though none by way of coarse meshes";
  if (diagnosis.status == SolveStatus::converged) return "the task has a plan";
  return fmt::format(
      "the task has a plan (its mesh was solved from the initial guess), but prowl plan does not find it: {}",
      diagnosis.stopped_by.empty() ? diagnosis.message : diagnosis.stopped_by);
}

/// Whether a proof speaks of the same goal and phase: "goal 1, phase 'swing': ...". A doubt then adds nothing.
bool is_certain(const std::string& doubt, const std::vector<std::string>& reasons) {
  const std::string subject = doubt.substr(0, doubt.find(": ") + 1);
  return std::ranges::any_of(reasons, [&](const std::string& reason) { return reason.starts_with(subject); });
}

Json to_json(const Breach& breach, const MotionProblem& problem) {
  return {{"kind", to_string(breach.kind)},
          {"phase", breach.phase + 1},
          {"phase_name", problem.phases[breach.phase].name},
          {"time_s", breach.time},
          {"subject", breach.subject},
          {"amount", breach.amount},
          {"unit", breach.unit},
          {"relative", breach.relative},
          {"words", in_words(breach, problem)}};
}

Json phase_to_json(int phase) { return phase < 0 ? Json(nullptr) : Json(phase + 1); }

Json to_json(const ProposedChange& change, const MotionProblem& problem) {
  return {{"kind", change.kind},
          {"phase", phase_to_json(change.phase)},
          {"subject", change.subject},
          {"from", change.from},
          {"to", change.to},
          {"unit", change.unit},
          {"factor", std::exp(change.amount)},
          {"besides", change.besides},
          {"is_proved", change.is_proved},
          {"was_tried", change.was_tried},
          {"passes", change.passes},
          {"words", in_words(change, problem)}};
}

}  // namespace

std::string diagnosis_headline(const Diagnosis& diagnosis, const MotionProblem& problem) {
  const std::string found = how_it_is_found(diagnosis),
                    plan = diagnosis.needs_one_mesh ? "prowl plan --one-mesh" : "prowl plan";
  if (diagnosis.solvable && diagnosis.certificate.passed) return found + ", and it passes its certificate";
  if (diagnosis.solvable) {
    const std::string next = holds_but_for_its_mesh(diagnosis.certificate)
                                 ? "its mesh is too coarse: " + plan + " --refine"
                             : diagnosis.changes.empty() ? fmt::format("all checks: {}, prowl check", plan)
                                                         : what_would_help(diagnosis, problem);
    return fmt::format("{}, but it fails its certificate: {}; {}", found, failed_checks(diagnosis.certificate), next);
  }
  return fmt::format("{}; {}", what_is_missing(diagnosis, problem), what_would_help(diagnosis, problem));
}

std::string diagnosis_text(const Diagnosis& diagnosis, const MotionProblem& problem) {
  const std::string headline = diagnosis_headline(diagnosis, problem);
  std::string text = fmt::format("{} {}: {}\n", problem.robot.name(), problem.name, headline);
  for (const std::string& reason : diagnosis.reasons) text += fmt::format("  certain      {}\n", reason);
  for (const std::string& hint : diagnosis.hints) {
    if (!is_certain(hint, diagnosis.reasons)) text += fmt::format("  doubtful     {}\n", hint);
  }
  for (std::size_t i = 0; i < std::min(diagnosis.breaches.size(), kMostBreaches); ++i) {
    text += fmt::format("  gives way    {}\n", in_words(diagnosis.breaches[i], problem));
  }
  if (diagnosis.breaches.size() > kMostBreaches) {
    text += fmt::format("  gives way    and {} more limits\n", diagnosis.breaches.size() - kMostBreaches);
  }
  for (const ProposedChange& change : diagnosis.changes) {
    const std::string proof =
        change.passes      ? "this plan passes its certificate"
        : change.is_proved ? "on the mesh of the task, which is too coarse for the certificate: --refine"
        : change.was_tried && diagnosis.search_intervals == diagnosis.task_intervals
            ? "solved from the initial guess, but the motion of prowl plan fails its certificate"
        : change.was_tried
            ? fmt::format("solved on {} mesh intervals, but not on the task's own", diagnosis.search_intervals)
            : fmt::format("solved on {} mesh intervals only", diagnosis.search_intervals);
    text += fmt::format("  {:<11}  with {} ({})\n",
                        change.passes      ? "solvable"
                        : change.is_proved ? "solved"
                                           : "perhaps",
                        in_words(change, problem), proof);
  }
  if (diagnosis.solvable) return text;
  if (diagnosis.interrupted)
    text += "interrupted before all changes were tried\n";
  else if (diagnosis.out_of_time)
    text += "the time was up before all changes were tried (--max-time)\n";
  return text;
}

std::string diagnosis_json(const Diagnosis& diagnosis, const MotionProblem& problem) {
  Json json = {{"name", problem.name},
               {"robot", problem.robot.name()},
               {"solvable", diagnosis.is_undecided() ? Json(nullptr) : Json(diagnosis.solvable)},
               {"passes", diagnosis.certificate.passed},
               {"needs_one_mesh", diagnosis.needs_one_mesh},
               {"status", to_string(diagnosis.status)},
               {"message", diagnosis.message},
               {"headline", diagnosis_headline(diagnosis, problem)},
               {"reasons", diagnosis.reasons},
               {"hints", diagnosis.hints},
               {"cause", nullptr},
               {"elastic", to_string(diagnosis.elastic_status)},
               {"search_intervals", diagnosis.search_intervals},
               {"breaches", Json::array()},
               {"changes", Json::array()},
               {"tried", diagnosis.tried},
               {"out_of_time", diagnosis.out_of_time},
               {"interrupted", diagnosis.interrupted}};
  if (!diagnosis.kind.empty()) {
    json["cause"] = {
        {"kind", diagnosis.kind}, {"phase", phase_to_json(diagnosis.phase)}, {"subject", diagnosis.subject}};
  }
  for (const Breach& breach : diagnosis.breaches) json["breaches"].push_back(to_json(breach, problem));
  for (const ProposedChange& change : diagnosis.changes) json["changes"].push_back(to_json(change, problem));
  return json_text(json);
}

}  // namespace prowl

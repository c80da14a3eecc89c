#include "screen/plan_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "screen/check_table.hpp"
#include "screen/mesh_advice.hpp"

namespace prowl {
namespace {

const char* in_words(SolveStatus status) {
  switch (status) {
    case SolveStatus::converged: return "converged";
    case SolveStatus::infeasible: return "infeasible: the solver found no motion that meets the constraints";
    case SolveStatus::iteration_limit: return "not finished: limit of iterations";
    case SolveStatus::time_limit: return "not finished: limit of time";
    case SolveStatus::interrupted: return "not finished: interrupted";
    case SolveStatus::evaluation_failed: return "numerical failure in the problem";
    case SolveStatus::solver_failed: return "the solver failed";
  }
  return "unknown";
}

/// 1e-06 as "1e-6".
std::string short_power(double value) {
  std::string text = fmt::format("{:g}", value);
  if (const std::size_t zero = text.find("e-0"); zero != std::string::npos) text.erase(zero + 2, 1);
  return text;
}

/// What a grade is good for, in a clause behind it.
std::string meaning(CertificateGrade grade) {
  const std::string error = short_power(CertificateLimits::integration_error_certified);
  switch (grade) {
    case CertificateGrade::failed: return "";
    case CertificateGrade::draft: return fmt::format(" (good for simulation; certified: error < {})", error);
    case CertificateGrade::certified: return fmt::format(" (error < {})", error);
  }
  return "";
}

/// Whether nothing costs anything: then all motions that keep the constraints are as good.
bool is_zero(const QuadraticCost& cost) {
  return cost.configuration_weight.isZero(0.0) && cost.velocity_weight.isZero(0.0) &&
         cost.acceleration_weight.isZero(0.0) && cost.torque_weight.isZero(0.0) && cost.force_weight.isZero(0.0) &&
         cost.time_weight == 0.0 && cost.contact_positions.empty();
}

/// "33 + 9 on 39 + 135 intervals", or the number alone where there was one mesh.
std::string iterations_in_words(const Plan& plan) {
  if (plan.levels.size() < 2) return fmt::format("{} iterations", plan.result.iterations);
  std::vector<int> iterations, intervals;
  for (const LevelResult& level : plan.levels) {
    iterations.push_back(level.iterations);
    intervals.push_back(level.intervals);
  }
  return fmt::format("{} iterations on {} intervals", fmt::join(iterations, " + "), fmt::join(intervals, ", "));
}

}  // namespace

std::string with_unit(double value, const std::string& unit) {
  return fmt::format("{:.3g}{}", value, unit.empty() || unit == "-" ? "" : " " + unit);
}

std::string failed_checks(const Certificate& certificate) {
  std::string text;
  for (const CertificateCheck& check : certificate.checks) {
    if (check.passed) continue;
    const std::string limit = with_unit(check.limit, ""), worst = with_unit(check.worst, "");
    text +=
        fmt::format("{}{} ({} > {})", text.empty() ? "" : ", ", check.name,
                    worst == limit ? fmt::format("{:.9g}", check.worst) : worst, with_unit(check.limit, check.unit));
  }
  return text;
}

std::string failed_checks_line(const Certificate& certificate) {
  const std::string checks = failed_checks(certificate);
  return checks.empty() ? "" : "failed: " + checks + "\n";
}

std::string plan_summary(const PlanRecord& record, const std::string& when) {
  const MotionProblem& problem = record.task.problem;
  const SolveResult& result = record.plan.result;
  const double duration = record.plan.trajectory.duration();
  if (!record.plan.reasons.empty()) {
    std::string text = fmt::format("{} {}{}: infeasible, which is proven: the solver did not start\n",
                                   problem.robot.name(), problem.name, when);
    for (const std::string& reason : record.plan.reasons) text += fmt::format("  reason       {}\n", reason);
    return text;
  }
  std::string text = fmt::format("{} {}{}: {}\n", problem.robot.name(), problem.name, when, in_words(result.status));
  const bool is_refined = !record.task.has_intervals && record.plan.levels.size() > 1;
  const std::string from = is_refined ? fmt::format(", refined from {}", record.plan.levels.front().intervals) : "";
  text += fmt::format("  mesh         {} phase{}, {} intervals{}, {:g} s; {} variables, {} constraints\n",
                      problem.phases.size(), problem.phases.size() == 1 ? "" : "s", record.plan.mesh.num_intervals(),
                      from, duration, record.plan.num_variables, record.plan.num_constraints);
  text += fmt::format("  solver       {}: {}, {:.2f} s (problem {:.2f} s)\n", record.plan.solver,
                      iterations_in_words(record.plan), result.seconds, result.times.evaluation());
  if (!record.warm_start.empty()) text += fmt::format("  started from {}\n", record.warm_start);
  text += fmt::format("  solution     cost {:.6g}, violation of constraints {:.1e}, dual {:.1e}\n", result.cost,
                      result.constraint_violation, result.dual_violation);
  if (is_zero(problem.running_cost) && is_zero(problem.terminal_cost)) {
    text +=
        "  note         without [cost] all motions count as equally good, so the result need not be smooth "
        "(docs/task-file.md)\n";
  }
  if (result.status != SolveStatus::converged) text += fmt::format("  message      {}\n", result.message);
  if (result.status != SolveStatus::converged && record.plan.certificate.passed) {
    text += "  note         the motion still passes its certificate; it misses only the tolerance of the solver\n";
  }
  for (const std::string& hint : record.plan.hints) text += fmt::format("  hint         {}\n", hint);
  return text;
}

std::string verdict_line(const Certificate& certificate) {
  return fmt::format("certificate: {}, grade: {}{}\n", certificate.passed ? "passed" : "FAILED",
                     to_string(certificate.grade), meaning(certificate.grade));
}

std::string certificate_summary(const Certificate& certificate, std::size_t columns) {
  std::vector<const CertificateCheck*> checks;
  for (const CertificateCheck& check : certificate.checks) checks.push_back(&check);
  std::string text = verdict_line(certificate) + check_table(checks, CheckColumn::time, columns);
  if (!certificate.redundant_contacts.empty()) {
    std::vector<std::string> ranks;
    for (const ContactRank& phase : certificate.contact_ranks) {
      if (phase.rank < phase.rows)
        ranks.push_back(fmt::format("'{}' rank {} of {} rows", phase.phase, phase.rank, phase.rows));
    }
    text += fmt::format("  The forces of {} are one choice of many; those of other contacts are unique ({}).\n",
                        fmt::join(certificate.redundant_contacts, ", "), fmt::join(ranks, ", "));
  }
  text += "A check passes if worst <= limit. A negative worst value is the margin left.\n";
  return text + failed_checks_line(certificate);
}

std::string robust_sentence(const PlanRecord& record) {
  if (!record.robustness) return "";
  const Robustness& robustness = *record.robustness;
  if (robustness.is_full()) return "Robust, to first order, against the disturbances asked for.\n";
  const std::string share =
      robustness.share == 0.0 ? "not robust" : fmt::format("robust at {:.0f} % of each size", 100.0 * robustness.share);
  return fmt::format("note: {}; the {} leaves least\n", share, robustness.tightest);
}

std::string feedback_summary(const FeedbackDesign& feedback, double step) {
  std::string text = fmt::format("feedback: {} gains, one every {:g} ms, {:.2f} s; bandwidth up to {:.0f} rad/s\n",
                                 feedback.num_samples(), step * 1e3, feedback.seconds, feedback.whole.bandwidth);
  const auto worst = std::max_element(feedback.decay.begin(), feedback.decay.end(),
                                      [](const PhaseDecay& a, const PhaseDecay& b) { return a.worst < b.worst; });
  text += fmt::format("  initial deviations decay to at most {:.1e} of their size ({})\n", feedback.whole.worst,
                      feedback.whole.worst_direction);
  if (worst->worst > 1.0) {
    text += fmt::format("  largest growth within a phase: {1:.1f} times in '{0}' ({2})\n", worst->name, worst->worst,
                        worst->worst_direction);
  }
  if (!feedback.stands_on) {
    text += feedback.slowest_rate < 0.0
                ? "  WARNING: the gains do not hold the robot after the end; tracking.bandwidth_radps makes them too "
                  "weak\n"
                : "  no gains for standing after the end: the contacts do not hold the robot\n";
  }
  return text;
}

std::string plan_report(const PlanRecord& record, const std::string& when, std::size_t columns) {
  if (!record.plan.reasons.empty()) return plan_summary(record, when);
  return plan_summary(record, when) + robust_sentence(record) + certificate_summary(record.plan.certificate, columns) +
         mesh_advice(record) + (record.feedback ? feedback_summary(*record.feedback, record.task.tracking.step) : "");
}

}  // namespace prowl

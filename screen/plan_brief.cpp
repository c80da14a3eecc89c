#include "screen/plan_brief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "prowl/certificate/term_checks.hpp"
#include "screen/check_table.hpp"
#include "screen/mesh_advice.hpp"
#include "screen/motion_sentence.hpp"
#include "screen/plan_summary.hpp"

namespace prowl {
namespace {

constexpr std::size_t kMostRows = 10;

/// Shown also where they pass, as are the user's terms.
constexpr std::array kOfEveryPlan{"goal position", "contact drift", "friction cone", "joint torque"};

/// The checks to show, in order: all that failed; if the others are too many beside them, those alone.
std::vector<const CertificateCheck*> shown_checks(const Certificate& certificate) {
  std::vector<const CertificateCheck*> failed, shown;
  for (const CertificateCheck& check : certificate.checks) {
    const bool always =
        std::ranges::find(kOfEveryPlan, check.name) != kOfEveryPlan.end() || check.name.starts_with(kTermCheck);
    if (!check.passed) failed.push_back(&check);
    if (!check.passed || is_draft(check) || always) shown.push_back(&check);
  }
  return shown.size() <= kMostRows || failed.empty() ? shown : failed;
}

std::string certificate_brief(const Certificate& certificate, const std::filesystem::path& directory,
                              std::size_t columns) {
  return verdict_line(certificate) + check_table(shown_checks(certificate), CheckColumn::used, columns) +
         fmt::format("Negative values are margin left. All {} checks: prowl check {}\n", certificate.checks.size(),
                     directory.string());
}

/// For somebody who has not seen a plan before: what the robot does, and what it takes.
std::string sentences(const PlanRecord& record) {
  const MotionProblem& problem = record.task.problem;
  const Plan& plan = record.plan;
  if (!is_good(plan)) return "";
  const std::string motion = motion_in_words(problem, plan.trajectory), torque = torque_in_words(plan.certificate);
  const std::string margin = missing_margin(problem, plan.trajectory, plan.certificate);
  return fmt::format("{} in {:.2f} s; planned in {:.1f} s.\n{}{}", motion, plan.trajectory.duration(),
                     plan.result.seconds, torque, torque.empty() ? "" : "\n") +
         (margin.empty() ? "" : fmt::format("note: {}\n", margin));
}

}  // namespace

std::string plan_brief(const PlanRecord& record, const std::filesystem::path& directory, std::size_t columns) {
  if (!record.plan.reasons.empty()) return plan_report(record);
  return plan_summary(record) + sentences(record) + robust_sentence(record) +
         certificate_brief(record.plan.certificate, directory, columns) + mesh_advice(record) +
         (record.feedback ? feedback_summary(*record.feedback, record.task.tracking.step) : "");
}

}  // namespace prowl

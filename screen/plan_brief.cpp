#include "screen/plan_brief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "screen/mesh_advice.hpp"
#include "screen/motion_sentence.hpp"
#include "screen/plan_summary.hpp"

namespace prowl {
namespace {

constexpr std::size_t kMostRows = 10;

/// Shown also where they pass.
constexpr std::array kOfEveryPlan{"goal position", "contact drift", "friction cone", "joint torque"};

bool is_draft(const CertificateCheck& check) { return check.passed && !(check.worst <= check.certified_limit); }

/// The checks to show, in order: all that failed; if the others are too many beside them, those alone.
std::vector<const CertificateCheck*> shown_checks(const Certificate& certificate) {
  std::vector<const CertificateCheck*> failed, shown;
  for (const CertificateCheck& check : certificate.checks) {
    const bool always = std::ranges::find(kOfEveryPlan, check.name) != kOfEveryPlan.end();
    if (!check.passed) failed.push_back(&check);
    if (!check.passed || is_draft(check) || always) shown.push_back(&check);
  }
  return shown.size() <= kMostRows || failed.empty() ? shown : failed;
}

/// Without the quantity of a coordinate, if need be: "RR_calf_joint" for "velocity of RR_calf_joint". Of names the end
/// tells more: "..arm_right_4_joint".
std::string cut(std::string text, std::size_t width) {
  if (const std::size_t of = text.find(" of "); text.size() > width && of != std::string::npos) text.erase(0, of + 4);
  return text.size() <= width ? text : ".." + text.substr(text.size() - (width - 2));
}

/// Share of the limit: "65 %"; none of what leaves a margin.
std::string used(const CertificateCheck& check) {
  constexpr double kMost = 9.99;
  const double share = check.worst / check.limit;
  if (!std::isfinite(share)) return "-";
  return share > kMost ? ">999 %" : fmt::format("{:.0f} %", 100.0 * std::max(0.0, share));
}

const char* verdict(const CertificateCheck& check) {
  return !check.passed ? "FAIL" : is_draft(check) ? "draft" : "pass";
}

std::string check_table(const std::vector<const CertificateCheck*>& checks, std::size_t columns) {
  using CheckRow = std::array<std::string, 6>;
  std::vector<CheckRow> rows = {{"check", "worst", "limit", "used", "where", ""}};
  for (const CertificateCheck* check : checks) {
    const std::string unit = check->unit == "of limit" ? "" : check->unit;  // the share says that
    rows.push_back({check->name, with_unit(check->worst, unit), with_unit(check->limit, ""), used(*check), check->where,
                    verdict(*check)});
  }
  constexpr std::size_t kWhere = 4, kGap = 2, kNarrowest = 8;
  std::array<std::size_t, 6> width{};
  for (const CheckRow& row : rows) {
    for (std::size_t i = 0; i < row.size(); ++i) width[i] = std::max(width[i], row[i].size());
  }
  std::size_t others = width.size() * kGap;
  for (std::size_t i = 0; i < width.size(); ++i) others += i == kWhere ? 0 : width[i];
  width[kWhere] = std::min(width[kWhere], std::max(kNarrowest, columns > others ? columns - others : 0));
  std::string text;
  for (CheckRow& row : rows) {
    row[kWhere] = cut(row[kWhere], width[kWhere]);
    const std::string line = fmt::format("  {:<{}}  {:>{}}  {:>{}}  {:>{}}  {:<{}}  {}", row[0], width[0], row[1],
                                         width[1], row[2], width[2], row[3], width[3], row[4], width[4], row[5]);
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

std::string certificate_brief(const Certificate& certificate, const std::filesystem::path& directory,
                              std::size_t columns) {
  return verdict_line(certificate) + check_table(shown_checks(certificate), columns) +
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
  return plan_summary(record) + sentences(record) + certificate_brief(record.plan.certificate, directory, columns) +
         mesh_advice(record) + (record.feedback ? feedback_summary(*record.feedback, record.task.tracking.step) : "");
}

}  // namespace prowl

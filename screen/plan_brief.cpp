#include "screen/plan_brief.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "screen/mesh_advice.hpp"
#include "screen/plan_summary.hpp"

namespace prowl {
namespace {

constexpr std::size_t kScreen = 80;  // [columns]
constexpr std::size_t kMostRows = 10;

/// Shown also where they pass.
constexpr std::array kOfEveryPlan{"goal position", "contact drift", "friction cone", "joint torque"};

bool is_draft(const CertificateCheck& check) { return check.passed && !(check.worst <= check.certified_limit); }

/// The checks to show, in order; if they are too many, the first of those that failed.
std::vector<const CertificateCheck*> shown_checks(const Certificate& certificate) {
  std::vector<const CertificateCheck*> failed, shown;
  for (const CertificateCheck& check : certificate.checks) {
    const bool always = std::ranges::find(kOfEveryPlan, check.name) != kOfEveryPlan.end();
    if (!check.passed) failed.push_back(&check);
    if (!check.passed || is_draft(check) || always) shown.push_back(&check);
  }
  if (shown.size() <= kMostRows) return shown;
  if (failed.size() > kMostRows) failed.resize(kMostRows);
  return failed.empty() ? shown : failed;
}

/// Of names the end tells more: "..of arm_right_4_joint".
std::string cut(const std::string& text, std::size_t width) {
  return text.size() <= width ? text : ".." + text.substr(text.size() - (width - 2));
}

std::string check_table(const std::vector<const CertificateCheck*>& checks) {
  constexpr std::size_t kVerdict = 5, kGap = 2;
  std::size_t name_width = 5, worst_width = 5;
  for (const CertificateCheck* check : checks) {
    name_width = std::max(name_width, check->name.size());
    worst_width = std::max(worst_width, with_unit(check->worst, check->unit).size());
  }
  const std::size_t where_width = kScreen - name_width - worst_width - kVerdict - 4 * kGap;
  std::string text;
  const auto line = [&](const std::string& name, const std::string& worst, const std::string& where,
                        const char* verdict) {
    const std::string row = fmt::format("  {:<{}}  {:>{}}  {:<{}}  {}", name, name_width, worst, worst_width,
                                        cut(where, where_width), where_width, verdict);
    text += row.substr(0, row.find_last_not_of(' ') + 1) + "\n";
  };
  line("check", "worst", "where", "");
  for (const CertificateCheck* check : checks) {
    line(check->name, with_unit(check->worst, check->unit), check->where,
         !check->passed     ? "FAIL"
         : is_draft(*check) ? "draft"
                            : "pass");
  }
  return text;
}

std::string certificate_brief(const Certificate& certificate, const std::filesystem::path& directory) {
  const std::vector<const CertificateCheck*> shown = shown_checks(certificate);
  std::string text = fmt::format("certificate: {}, grade: {}\n", certificate.passed ? "passed" : "FAILED",
                                 to_string(certificate.grade));
  text += check_table(shown);
  text += fmt::format("worst < 0: so much is left; limits and all {} checks: prowl check {}\n",
                      certificate.checks.size(), directory.string());
  return text + failed_checks_line(certificate);
}

}  // namespace

std::string plan_brief(const PlanRecord& record, const std::filesystem::path& directory) {
  if (!record.plan.reasons.empty()) return plan_report(record);
  return plan_summary(record) + certificate_brief(record.plan.certificate, directory) + mesh_advice(record) +
         (record.feedback ? feedback_summary(*record.feedback, record.task.tracking.step) : "");
}

}  // namespace prowl

#include "screen/mesh_advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "prowl/certificate/mesh_errors.hpp"
#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/task_file/interval_shares.hpp"

namespace prowl {
namespace {

constexpr double kMargin = 1.25;  // on the error

/// The least --intervals, `needed` or more, that keeps every goal at a node.
std::optional<int> intervals_option(const Task& task, double needed) {
  const std::vector<int> of_phase = interval_divisors(task.problem, task.mesh);
  if (!(needed <= kMostIntervals)) return std::nullopt;
  for (int total = static_cast<int>(std::ceil(needed)); total <= kMostIntervals; ++total) {
    const std::vector<int> shares = share_intervals(task.file_intervals, total);
    bool keeps_goals = true;
    for (std::size_t p = 0; p < shares.size(); ++p) keeps_goals = keeps_goals && shares[p] % of_phase[p] == 0;
    if (keeps_goals) return total;
  }
  return std::nullopt;
}

}  // namespace

std::string mesh_advice(const PlanRecord& record) {
  const auto& errors = record.plan.certificate.interval_errors;
  const auto worst =
      std::max_element(errors.begin(), errors.end(), [](const auto& a, const auto& b) { return a.error < b.error; });
  if (record.plan.result.status != SolveStatus::converged || worst == errors.end() || !std::isfinite(worst->error))
    return "";
  if (!fails_by_mesh_only(record.plan.certificate)) return "";
  // With other steps, or corrections, equal steps of the trapezoid are no remedy.
  const bool is_plain = record.plan.mesh.is_even() && record.plan.trajectory.interpolation == Interpolation::trapezoid;
  std::string text;
  const auto advise = [&](const char* grade, double goal) {
    if (worst->error <= goal) return;
    std::string option = fmt::format("--refine {}", grade);
    if (!is_plain) option += " --warm-start with the folder of this plan";  // from where it stopped
    if (is_plain) {
      const double needed = static_cast<double>(errors.size()) * std::cbrt(kMargin * worst->error / goal);
      const std::optional<int> intervals = intervals_option(record.task, needed);
      option = fmt::format("{}, or {}",
                           intervals ? fmt::format("about --intervals {}", *intervals)
                                     : fmt::format("about more than {} intervals", kMostIntervals),
                           option);
    }
    text += fmt::format("for grade {} ({:g}) {}\n", grade, goal, option);
  };
  advise("draft", CertificateLimits::integration_error_draft);
  advise("certified", CertificateLimits::integration_error_certified);
  if (text.empty()) return "";
  return fmt::format("local integration error {:.1e} with {} intervals:\n", worst->error, errors.size()) + text;
}

}  // namespace prowl

#include "screen/check_table.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>

#include "screen/plan_summary.hpp"

namespace prowl {
namespace {

// Columns of the table.
constexpr std::size_t kWorst = 1, kLimit = 2, kFourth = 3, kWhere = 4, kColumns = 6;
constexpr std::size_t kGap = 2;
constexpr std::size_t kNarrowest = 8;  ///< of the column "where"
using CheckRow = std::array<std::string, kColumns>;
using Widths = std::array<std::size_t, kColumns>;  ///< 0: left out

/// Shortened if necessary: "velocity of RR_calf_joint" to "RR_calf_joint", "goal 1, base z" to "base z", then to
/// "RR_calf", then to the end.
std::string cut(std::string text, std::size_t width) {
  constexpr std::string_view kJoint = "_joint";
  if (const std::size_t of = text.find(" of "); text.size() > width && of != std::string::npos) text.erase(0, of + 4);
  if (const std::size_t comma = text.find(", "); text.size() > width && comma != std::string::npos)
    text.erase(0, comma + 2);
  if (text.size() > width && text.ends_with(kJoint)) text.resize(text.size() - kJoint.size());
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

CheckRow check_row(const CertificateCheck& check, CheckColumn fourth) {
  const bool has_share = fourth == CheckColumn::used;
  const std::string unit = check.unit == "of limit" ? "" : check.unit;  // the limit beside it is 1
  return {check.name,
          with_unit(check.worst, unit),
          with_unit(check.limit, ""),
          has_share ? used(check) : fmt::format("{:.3f} s", check.time),
          check.where,
          verdict(check)};
}

std::size_t total(const Widths& widths) {
  std::size_t sum = 0;
  for (const std::size_t width : widths) sum += width > 0 ? width + kGap : 0;
  return sum;
}

/// Narrows the column of places, and leaves out one after the other.
void fit(Widths& widths, CheckColumn fourth, std::size_t columns) {
  const auto narrow = [&widths, columns, widest = widths[kWhere]] {
    const std::size_t others = total(widths) - widths[kWhere];
    widths[kWhere] = std::min(widest, std::max(kNarrowest, columns > others ? columns - others : 0));
  };
  narrow();
  if (fourth == CheckColumn::time && total(widths) > columns) {
    widths[kFourth] = 0;
    narrow();
  }
  for (const std::size_t column : {kWhere, kLimit, kWorst}) {
    if (total(widths) > columns) widths[column] = 0;
  }
}

}  // namespace

bool is_draft(const CertificateCheck& check) { return check.passed && !(check.worst <= check.certified_limit); }

std::string check_table(const std::vector<const CertificateCheck*>& checks, CheckColumn fourth, std::size_t columns) {
  std::vector<CheckRow> rows = {
      {"check", "worst", "limit", fourth == CheckColumn::used ? "used" : "time", "where", ""}};
  for (const CertificateCheck* check : checks) rows.push_back(check_row(*check, fourth));
  Widths widths{};
  for (const CheckRow& row : rows) {
    for (std::size_t i = 0; i < kColumns; ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  fit(widths, fourth, columns);
  std::string text;
  for (CheckRow& row : rows) {
    std::string line;
    for (std::size_t i = 0; i < kColumns; ++i) {
      if (widths[i] == 0) continue;
      const bool is_number = i == kWorst || i == kLimit || i == kFourth;
      const std::string cell = i == kWhere ? cut(row[i], widths[i]) : row[i];
      line += fmt::format(fmt::runtime(is_number ? "  {:>{}}" : "  {:<{}}"), cell, widths[i]);
    }
    text += line.substr(0, line.find_last_not_of(' ') + 1) + "\n";
  }
  return text;
}

}  // namespace prowl

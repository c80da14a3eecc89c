#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options/shared_options.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/doctor_checks.hpp"
#include "prowl/files/json_text.hpp"

namespace prowl::cli {
namespace {

const char* word(Finding::State state) {
  switch (state) {
    case Finding::State::ok: return "ok";
    case Finding::State::slow: return "slow";
    case Finding::State::missing: return "missing";
    case Finding::State::foreign: return "foreign";
  }
  return "";
}

std::string table(const std::vector<Finding>& findings) {
  std::size_t width = 0;
  for (const Finding& finding : findings) width = std::max(width, finding.name.size());
  std::string text, area;
  for (const Finding& finding : findings) {
    if (finding.area != area) text += finding.area + "\n";
    area = finding.area;
    text += fmt::format("  {:<7}  {:<{}}  {}\n", word(finding.state), finding.name, width, finding.text);
    if (!finding.remedy.empty()) text += fmt::format("  {:<7}  {:<{}}  -> {}\n", "", "", width, finding.remedy);
  }
  return text;
}

std::string verdict(const std::vector<Finding>& findings) {
  const auto names = [&](Finding::State state) {
    std::vector<std::string> list;
    for (const Finding& finding : findings) {
      if (finding.state == state) list.push_back(finding.name);
    }
    return fmt::format("{}", fmt::join(list, ", "));
  };
  const std::string missing = names(Finding::State::missing);
  std::string text = missing.empty() ? "nothing is missing" : "missing: " + missing;
  for (const Finding::State state : {Finding::State::slow, Finding::State::foreign}) {
    if (const std::string list = names(state); !list.empty()) text += fmt::format("; {}: {}", word(state), list);
  }
  return text + "\n";
}

std::string json(const std::vector<Finding>& findings, ExitStatus status) {
  nlohmann::ordered_json checks = nlohmann::ordered_json::array();
  for (const Finding& finding : findings) {
    checks.push_back({{"area", finding.area},
                      {"name", finding.name},
                      {"state", word(finding.state)},
                      {"text", finding.text},
                      {"remedy", finding.remedy},
                      {"exit_status", static_cast<int>(finding.status)}});
  }
  return json_text({{"ok", status == kPassed}, {"checks", checks}});
}

int run_doctor(bool as_json) {
  std::vector<Finding> findings;
  for (const auto& check : {check_build, check_machine, check_solvers, check_files}) {
    const std::vector<Finding> more = check();
    findings.insert(findings.end(), more.begin(), more.end());
  }
  const auto bad =
      std::find_if(findings.begin(), findings.end(), [](const Finding& finding) { return finding.status != kPassed; });
  const ExitStatus status = bad == findings.end() ? kPassed : bad->status;
  if (as_json) {
    print_json({.verb = "doctor", .exit_status = status, .result = json(findings, status)});
  } else {
    print_result(table(findings) + verdict(findings));
  }
  return status;
}

}  // namespace

void add_doctor_command(CLI::App& app, int& status) {
  const auto as_json = std::make_shared<bool>(false);
  CLI::App* const verb =
      app.add_subcommand("doctor", "Check this machine: what works, what is slow or missing, and the remedy");
  add_json(*verb, *as_json);
  set_footer(*verb, {"prowl doctor"},
             "0 planning works, even if something is slow or a verb like figures lacks its parts; "
             "3 a solver does not work; 4 the URDFs of the robots that come with Prowl are not found.");
  verb->callback([as_json, &status] { status = run_doctor(*as_json); });
}

}  // namespace prowl::cli

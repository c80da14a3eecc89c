#include "cli/verbs/report_page.hpp"

#include <fmt/format.h>

#include "cli/process/program_files.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/plan_tracker.hpp"
#include "prowl/error.hpp"
#include "prowl/files/csv_table.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestPage = 16u << 20;  ///< [bytes]

std::optional<SourceText> read_if_there(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  return read_text_file(file, kLongestTable);
}

}  // namespace

std::string page_without_data(const std::string& name) {
  std::error_code ignored;
  const fs::path page = share_folder() / (name + ".html");
  if (!fs::exists(page, ignored)) {
    throw FileError(
        fmt::format("{}: missing; scripts/setup builds it from report/, with the Node.js in .venv", page.string()));
  }
  return read_text_file(page, kLongestPage).text;
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) print_message(fmt::format("warning: {}\n", warning));
}

ReportInputs report_inputs(const PlanRecord& plan, const fs::path& directory) {
  ReportInputs inputs{.plan = plan, .directory = directory.string(), .template_html = page_without_data("report")};
  if (directory.empty()) return inputs;
  inputs.simulation = read_if_there(directory / "simulate.csv");
  inputs.simulation_json = read_if_there(directory / "simulate.json");
  std::error_code ignored;
  if (fs::exists(directory / "tracker.bin", ignored))
    inputs.tracking = read_tracker(directory, plan.task.problem).plan();
  return inputs;
}

Report report_page(const ReportInputs& inputs, const PackageSearch& search, const ReportInputs* other) {
  Report report = make_report(inputs, search, other);
  print_warnings(report.warnings);
  return report;
}

}  // namespace prowl::cli

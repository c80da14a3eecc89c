#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/report_page.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/report_page/report_file.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::string directory, other, out;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  bool json = false;
};

WrittenReport write_page(const Report& report, const fs::path& out, const std::string& content, bool has_simulation) {
  write_file_atomically(out, report.html);
  print_message(
      fmt::format("report: {}, {:.1f} MB{}\n", out.string(), 1e-6 * static_cast<double>(report.html.size()), content));
  return {report.html.size(), has_simulation, report.warnings};
}

/// Beside the first folder, named after both: a folder of a plan contains the files of that plan only.
fs::path comparison_file(const fs::path& first, const fs::path& second) {
  const auto name = [](const fs::path& folder) {
    return fs::absolute(folder / "").lexically_normal().parent_path().filename().string();
  };
  return ((first / "..").lexically_normal() / fmt::format("report-{}-{}.html", name(first), name(second)))
      .lexically_normal();
}

/// Two plans in one page.
WrittenReport write_comparison(const PlanRecord& plan, const ReportArguments& arguments, const fs::path& out,
                               const PackageSearch& search) {
  const PlanRecord other = read_plan(arguments.other, search, arguments.own_terms);
  const ReportInputs inputs = report_inputs(plan, arguments.directory);
  const ReportInputs compared = report_inputs(other, arguments.other);
  return write_page(report_page(inputs, search, &compared), out, ", of two plans", inputs.simulation.has_value());
}

}  // namespace

WrittenReport write_report(const PlanRecord& plan, const fs::path& directory, const fs::path& out,
                           const PackageSearch& search) {
  const ReportInputs inputs = report_inputs(plan, directory);
  const Report report = report_page(inputs, search);
  return write_page(report, out, inputs.simulation ? "" : ", of the plan only: there is no simulation",
                    inputs.simulation.has_value());
}

void add_report_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* const verb = app.add_subcommand("report", "Write a page that replays a plan in a browser");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("other", arguments->other, "Folder of a second plan, to compare with the first")->type_name("DIR");
  verb->add_option("--out", arguments->out,
                   "File to write; default: DIR/report.html, for two plans report-DIR-DIR.html beside the first")
      ->type_name("FILE");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  set_footer(
      *verb,
      {"prowl simulate out/hyq_crouch && prowl report out/hyq_crouch", "prowl report out/hyq_crouch --out crouch.html",
       "prowl report out/hyq_crouch out/stand   into out/report-hyq_crouch-stand.html"},
      "0 if the page is written, 2 bad input, 4 files. The page is one file and needs no network.");
  verb->callback([arguments, &status] {
    const fs::path directory = arguments->directory;
    const fs::path out = !arguments->out.empty()    ? fs::path(arguments->out)
                         : arguments->other.empty() ? directory / kReportFile
                                                    : comparison_file(directory, arguments->other);
    const PackageSearch search = package_search(arguments->package_dirs);
    const PlanRecord plan = read_plan(directory, search, arguments->own_terms);
    const WrittenReport report = arguments->other.empty() ? write_report(plan, directory, out, search)
                                                          : write_comparison(plan, *arguments, out, search);
    if (arguments->json) {
      const nlohmann::json result = {
          {"bytes", report.bytes}, {"simulation", report.has_simulation}, {"warnings", report.warnings}};
      print_json(
          {.verb = "report", .plan = &plan, .directory = directory, .written = {out}, .result = json_text(result)});
    }
    status = kPassed;
  });
}

}  // namespace prowl::cli

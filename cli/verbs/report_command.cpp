#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "cli/exit_status.hpp"
#include "cli/options/shared_options.hpp"
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
  std::string directory, out;
  std::vector<std::string> package_dirs;
  bool json = false;
};

}  // namespace

WrittenReport write_report(const PlanRecord& plan, const fs::path& directory, const fs::path& out,
                           const PackageSearch& search) {
  const ReportInputs inputs = report_inputs(plan, directory);
  const Report report = report_page(inputs, search);
  write_file_atomically(out, report.html);
  print_message(fmt::format("report: {}, {:.1f} MB{}\n", out.string(), 1e-6 * static_cast<double>(report.html.size()),
                            inputs.simulation ? "" : ", of the plan alone: there is no simulation"));
  return {report.html.size(), inputs.simulation.has_value(), report.warnings};
}

void add_report_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* const verb = app.add_subcommand("report", "Write a page that replays a plan in a browser");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--out", arguments->out, "File to write; default: DIR/report.html")->type_name("FILE");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(
      *verb,
      {"prowl simulate out/hyq_crouch && prowl report out/hyq_crouch", "prowl report out/hyq_crouch --out crouch.html"},
      "0 if the page is written, 2 bad input, 4 files. The page is one file and needs no network.");
  verb->callback([arguments, &status] {
    const fs::path directory = arguments->directory;
    const fs::path out = arguments->out.empty() ? directory / kReportFile : fs::path(arguments->out);
    const PackageSearch search = package_search(arguments->package_dirs);
    const PlanRecord plan = read_plan(directory, search);
    const WrittenReport report = write_report(plan, directory, out, search);
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

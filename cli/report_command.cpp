#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "environment.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "prowl/io/atomic_folder.hpp"
#include "prowl/io/report_file.hpp"
#include "report_page.hpp"
#include "shared_options.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

struct ReportArguments {
  std::string directory, out;
  std::vector<std::string> package_dirs;
};

}  // namespace

void write_report(const PlanRecord& plan, const fs::path& directory, const fs::path& out, const PackageSearch& search) {
  const ReportInputs inputs = report_inputs(plan, directory);
  const std::string html = report_page(inputs, search);
  write_file_atomically(out, html);
  print_message(fmt::format("report: {}, {:.1f} MB{}\n", out.string(), 1e-6 * static_cast<double>(html.size()),
                            inputs.simulation ? "" : ", of the plan alone: there is no simulation"));
}

void add_report_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* const verb = app.add_subcommand("report", "Write a page that replays a plan in a browser");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--out", arguments->out, "Where to write it; default: DIR/report.html")->type_name("FILE");
  add_package_dirs(*verb, arguments->package_dirs);
  verb->footer("Example:\n  prowl simulate out/hyq_crouch && prowl report out/hyq_crouch\n\n"
               "One file that needs no network and no other file. Exit status: 0 if it is written.");
  verb->callback([arguments, &status] {
    const fs::path directory = arguments->directory;
    const PackageSearch search = package_search(arguments->package_dirs);
    write_report(read_plan(directory, search), directory,
                 arguments->out.empty() ? directory / kReportFile : fs::path(arguments->out), search);
    status = kPassed;
  });
}

}  // namespace prowl::cli

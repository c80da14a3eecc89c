#include <fmt/format.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "commands.hpp"
#include "environment.hpp"
#include "exit_status.hpp"
#include "json_result.hpp"
#include "output.hpp"
#include "plan_tracker.hpp"
#include "prowl/error.hpp"
#include "prowl/io/atomic_folder.hpp"
#include "prowl/io/json_text.hpp"
#include "prowl/io/report_file.hpp"
#include "shared_options.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestSimulation = 1u << 30;  ///< [bytes]
constexpr std::size_t kLongestPage = 16u << 20;       ///< [bytes]

struct ReportArguments {
  std::string directory, out;
  std::vector<std::string> package_dirs;
  bool json = false;
};

/// PREFIX/bin/prowl: PREFIX/share/prowl/report.html, installed as well as in a build.
std::string page_without_data() {
  std::error_code ignored;
  const fs::path executable = fs::read_symlink("/proc/self/exe", ignored);
  const fs::path page = executable.parent_path().parent_path() / "share/prowl/report.html";
  if (!fs::exists(page, ignored)) {
    throw FileError(fmt::format("{}: missing; scripts/setup builds it from report/, with the Node.js in .venv", page.string()));
  }
  return read_text_file(page, kLongestPage).text;
}

std::optional<SourceText> read_if_there(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored)) return std::nullopt;
  return read_text_file(file, kLongestSimulation);
}

}  // namespace

WrittenReport write_report(const PlanRecord& plan, const fs::path& directory, const fs::path& out, const PackageSearch& search) {
  ReportInputs inputs{.plan = plan,
                      .directory = directory.string(),
                      .simulation = read_if_there(directory / "simulate.csv"),
                      .simulation_json = read_if_there(directory / "simulate.json"),
                      .tracking = {},
                      .template_html = page_without_data()};
  std::error_code ignored;
  if (fs::exists(directory / "tracker.bin", ignored)) inputs.tracking = read_tracker(directory, plan.task.problem).plan();
  const Report report = make_report(inputs, search);
  for (const std::string& warning : report.warnings) print_message(fmt::format("warning: {}\n", warning));
  write_file_atomically(out, report.html);
  print_message(fmt::format("report: {}, {:.1f} MB{}\n", out.string(), 1e-6 * static_cast<double>(report.html.size()),
                            inputs.simulation ? "" : ", of the plan alone: there is no simulation"));
  return {report.html.size(), inputs.simulation.has_value(), report.warnings};
}

void add_report_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ReportArguments>();
  CLI::App* const verb = app.add_subcommand("report", "Write a page that replays a plan in a browser");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--out", arguments->out, "Where to write it; default: DIR/report.html")->type_name("FILE");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb, {"prowl simulate out/hyq_crouch && prowl report out/hyq_crouch", "prowl report out/hyq_crouch --out crouch.html"},
             "0 if it is written, 2 bad input, 4 files. It is one file that needs no network and no other file.");
  verb->callback([arguments, &status] {
    const fs::path directory = arguments->directory;
    const fs::path out = arguments->out.empty() ? directory / kReportFile : fs::path(arguments->out);
    const PackageSearch search = package_search(arguments->package_dirs);
    const PlanRecord plan = read_plan(directory, search);
    const WrittenReport report = write_report(plan, directory, out, search);
    if (arguments->json) {
      const nlohmann::json result = {{"bytes", report.bytes}, {"simulation", report.has_simulation}, {"warnings", report.warnings}};
      print_json({.verb = "report", .plan = &plan, .directory = directory, .written = {out}, .result = json_text(result)});
    }
    status = kPassed;
  });
}

}  // namespace prowl::cli

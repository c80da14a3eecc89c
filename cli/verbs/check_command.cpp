#include <fmt/format.h>

#include <memory>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/terminal.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "screen/plan_summary.hpp"

namespace prowl::cli {
namespace {

struct CheckArguments {
  std::string directory;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  bool json = false;
};

int run_check(const CheckArguments& arguments) {
  PlanRecord record = read_plan(arguments.directory, package_search(arguments.package_dirs), arguments.own_terms);
  const CertificateGrade recorded = record.plan.certificate.grade;
  record.plan.certificate = certify({record.task.problem, record.plan.mesh}, record.plan.trajectory);
  const Certificate& certificate = record.plan.certificate;
  if (certificate.grade != recorded) {
    print_note(fmt::format("plan.json records grade {}, this check found {}", to_string(recorded),
                           to_string(certificate.grade)));
  }
  const int status = exit_status(record.plan.result.status, certificate);
  if (arguments.json) {
    print_json({.verb = "check",
                .exit_status = status,
                .plan = &record,
                .directory = arguments.directory,
                .result = plan_report_json(record, arguments.directory)});
  } else {
    print_result(wrap(plan_report(record, " (as planned)", columns_of_table()), columns_of_table()));
  }
  return status;
}

}  // namespace

void add_check_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<CheckArguments>();
  CLI::App* const verb = app.add_subcommand("check", "Check a finished plan again, from its files alone");
  add_plan_directory(*verb, arguments->directory);
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  set_footer(*verb, {"prowl check out/hyq_crouch", "prowl check out/hyq_crouch --json"}, "as prowl plan.");
  verb->callback([arguments, &status] { status = run_check(*arguments); });
}

}  // namespace prowl::cli

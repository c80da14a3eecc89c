#include <fmt/format.h>

#include <memory>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "prowl/feasibility/plausibility.hpp"
#include "prowl/session/diagnose_task.hpp"
#include "prowl/task_file/task_file.hpp"
#include "screen/diagnosis_text.hpp"

namespace prowl::cli {
namespace {

struct DiagnoseArguments {
  std::string task;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  double max_seconds = DiagnosisOptions().max_seconds;
  bool json = false;
};

ExitStatus exit_status(const Diagnosis& diagnosis) {
  const bool was_planned = diagnosis.solvable && diagnosis.stopped_by.empty();
  if (diagnosis.interrupted && !was_planned) return kInterrupted;
  if (diagnosis.solvable) return diagnosis.certificate.passed ? kPassed : kCertificateFailed;
  return diagnosis.is_undecided() ? kLimit : kNotSolved;
}

int run_diagnose(const DiagnoseArguments& arguments) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const Task task = read_task_file(arguments.task, package_search(arguments.package_dirs), {}, arguments.own_terms);
  for (const std::string& line : implausibilities(task.problem, task.mesh)) print_note(line);
  DiagnosisOptions options{.solver = {}, .max_seconds = arguments.max_seconds};
  options.solver.interrupt = &interrupted;
  options.on_step = [](const std::string& what) { print_progress(what + "\n"); };
  const Diagnosis diagnosis = diagnose_task(task, options);
  const int status = exit_status(diagnosis);
  if (arguments.json) {
    print_json({.verb = "diagnose", .exit_status = status, .result = diagnosis_json(diagnosis, task.problem)});
  } else {
    print_result(wrap(diagnosis_text(diagnosis, task.problem)));
  }
  return status;
}

}  // namespace

void add_diagnose_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<DiagnoseArguments>();
  CLI::App* const verb = app.add_subcommand("diagnose", "Find out why a task has no plan, and what would help");
  add_task(*verb, arguments->task);
  verb->add_option("--max-time", arguments->max_seconds,
                   fmt::format("Time limit in seconds; default {:g}", arguments->max_seconds))
      ->check(number_in(NumberRange::positive()))
      ->type_name("S");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  set_footer(
      *verb, {"prowl diagnose tasks/hyq/crouch.toml", "prowl diagnose tasks/hyq/crouch.toml --max-time 60 --json"},
      "0 the task has a plan that passes its certificate; 2 bad input; 3 no plan, with or without a known cause; 6 "
      "time or iterations ran out before that was known; 7 there is a plan, but its certificate fails; 130 "
      "interrupted: prints the findings so far.");
  verb->callback([arguments, &status] { status = run_diagnose(*arguments); });
}

}  // namespace prowl::cli

#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/report_page.hpp"
#include "cli/verbs/view_server.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/session/environment.hpp"
#include "prowl/session/plan_task.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "screen/plan_summary.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

struct ViewArguments {
  std::string target, out;
  std::string solver = solver_names().front();
  std::uint16_t port = 0;
  TaskOverrides overrides;
  bool one_mesh = false;
  bool json = false;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
};

void say_where(const ViewServer& server, bool json) {
  if (json) {
    print_json({.verb = "view", .result = nlohmann::json{{"url", server.url()}}.dump()});
  } else {
    print_result(server.url() + "\n");
  }
  print_message(kHowToOpen);
}

int view_plan(const ViewArguments& arguments, const std::atomic<bool>& interrupted) {
  const PackageSearch search = package_search(arguments.package_dirs);
  const PlanRecord record = read_plan(arguments.target, search, arguments.own_terms);
  ViewServer server(arguments.port);
  server.show(report_page(report_inputs(record, arguments.target), search).html);
  say_where(server, arguments.json);
  serve_until(interrupted);
  return kPassed;
}

/// Solves the task and sends every iterate to the server.
PlannedTask solve(const ViewArguments& arguments, const std::atomic<bool>& interrupted, Task task, ViewServer& server) {
  const MotionProblem problem = task.problem;
  PlanRequest request{.solver = arguments.solver, .coarse_first = !arguments.one_mesh, .gains = false};
  request.interrupt = &interrupted;
  ProgressPrinter progress;
  progress.watch(request);
  MeshIteration now{.level = -1};
  request.on_mesh = [&now, print = request.on_mesh](int intervals) {
    ++now.level;
    print(intervals);
  };
  request.on_iteration = [&now, print = request.on_iteration](const SolveProgress& at) {
    now.progress = at;
    print(at);
  };
  request.on_iterate = [&](const Plan& iterate) { server.publish("iterate", report_iterate(problem, iterate, now)); };
  return plan_task(std::move(task), request);
}

int view_task(const ViewArguments& arguments, const std::atomic<bool>& interrupted) {
  const PackageSearch search = package_search(arguments.package_dirs);
  PlanRecord record{.task = read_task_file(arguments.target, search, arguments.overrides, arguments.own_terms),
                    .plan = {},
                    .versions = versions_with(arguments.solver)};
  const DiscreteProblem asked(record.task.problem, record.task.mesh);
  if (!arguments.out.empty()) check_plan_directory(arguments.out);
  record.plan.trajectory = initial_guess(asked);
  record.plan.mesh = asked.mesh;
  record.plan.solver = make_solver(arguments.solver)->name();

  ViewServer server(arguments.port);
  const auto show = [&](PageState state) {
    ReportInputs inputs = report_inputs(record, "");
    inputs.directory = arguments.out;
    inputs.state = state;
    server.show(report_page(inputs, search).html);
  };
  show(PageState::solving);
  say_where(server, arguments.json);
  PlannedTask planned = solve(arguments, interrupted, record.task, server);
  record = std::move(planned.record);
  if (!arguments.out.empty()) write_plan(arguments.out, record);
  show(PageState::solved);
  server.publish("solved", "{}");
  print_message(plan_report(record) + (arguments.out.empty() ? "" : fmt::format("written to {}\n", arguments.out)));
  const int status =
      planned.interrupted ? kInterrupted : exit_status(record.plan.result.status, record.plan.certificate);
  serve_until(interrupted);
  return status;
}

}  // namespace

void add_view_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ViewArguments>();
  CLI::App* const verb = app.add_subcommand("view", "Show a plan in a browser, or a task while it is planned");
  verb->add_option("target", arguments->target, "Task file, shipped task or plan folder")
      ->required()
      ->type_name("TASK.toml|DIR")
      ->transform(CLI::Validator([](std::string& name) { return name = find_task(name), std::string(); }, ""));
  verb->add_option("--port", arguments->port, "Port of 127.0.0.1; default: any free one")
      ->check(port_number())
      ->type_name("N");
  add_folder(*verb, "--out", arguments->out, "Folder to write the plan of a task into; default: none");
  add_intervals(*verb, arguments->overrides)->group(kMeshOptions);
  verb->add_flag("--one-mesh", arguments->one_mesh, "Solve on this mesh at once, without coarser ones first")
      ->group(kMeshOptions);
  verb->add_option("--solver", arguments->solver, "Solver to use; default " + arguments->solver)
      ->check(one_of(solver_names()))
      ->type_name("NAME")
      ->group(kSolverOptions);
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  set_footer(*verb, {"prowl view tasks/hyq/walk.toml", "prowl view out/hyq_crouch --port 8080"},
             "0 for a folder, as prowl plan for a task, after Ctrl-C. The page is that of prowl report, served on "
             "the loopback interface; for a task it has a slider over the iterates of the solver.");
  verb->callback([arguments, &status] {
    const std::atomic<bool>& interrupted = catch_interrupts();
    std::error_code ignored;
    status = fs::is_directory(arguments->target, ignored) ? view_plan(*arguments, interrupted)
                                                          : view_task(*arguments, interrupted);
  });
}

}  // namespace prowl::cli

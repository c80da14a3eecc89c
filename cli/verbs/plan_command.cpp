#include <fmt/format.h>

#include <memory>
#include <optional>
#include <thread>

#include "cli/options/checkpoint_option.hpp"
#include "cli/options/refine_option.hpp"
#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress.hpp"
#include "cli/screen/progress_bar.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "prowl/error.hpp"
#include "prowl/feasibility/plausibility.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/report_page/report_file.hpp"
#include "prowl/session/plan_task.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "screen/phase_table.hpp"
#include "screen/plan_brief.hpp"

namespace prowl::cli {
namespace {

struct PlanArguments {
  std::string task;
  std::string out;
  std::string warm_start;
  PlanRequest request{.solver = solver_names().front()};
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  TaskOverrides overrides;
  std::optional<double> step;  ///< [s]
  CheckpointArguments checkpoint;
  bool json = false;
  bool print_phases = false;
  bool report = false;
};

/// Existing files of a plan in its folder.
std::vector<std::filesystem::path> files_of_plan(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"plan.json", "trajectory.csv", "trajectory_uniform.csv", "tracker.bin", kReportFile}) {
    if (std::filesystem::exists(directory / name)) files.push_back(directory / name);
  }
  return files;
}

int print_phases(const Task& task, bool json) {
  const DiscreteProblem problem(task.problem, task.mesh);
  if (json) {
    print_json({.verb = "plan", .result = phases_json(problem)});
  } else {
    print_result(phase_table(problem));
  }
  return kPassed;
}

/// Throws InputError if --dt gives too many samples.
void check_step(const Task& task, std::optional<double> step) {
  double duration = 0.0;
  for (const Phase& phase : task.problem.phases) duration += phase.duration.max;
  if (step && duration / *step > kMostUniformSamples) {
    throw InputError(fmt::format("--dt: {} s is too fine for a motion of {} s", *step, duration));
  }
}

/// Warns of more threads than cores.
void note_threads(int threads) {
  const int cores = static_cast<int>(std::thread::hardware_concurrency());
  if (cores == 0 || threads <= cores) return;
  print_note(fmt::format("--threads {}: this machine has {} core{}; more threads are no faster", threads, cores,
                         cores == 1 ? "" : "s"));
}

/// Like check(), with "--" before the names, which are those of the options.
void check_options(const PlanRequest& request) {
  try {
    check(request);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--{}", error.what()));
  }
}

/// Reads the plan of --warm-start or --resume, if any, and makes it the start of the request.
std::optional<PlanRecord> read_earlier_plan(const PlanArguments& arguments, const PackageSearch& search, Task& task,
                                            PlanRequest& request) {
  std::optional<PlanRecord> earlier_plan;
  if (!arguments.warm_start.empty()) {
    earlier_plan = read_plan(arguments.warm_start, search, arguments.own_terms);
    request.warm_start = {.folder = arguments.warm_start, .option = "--warm-start " + arguments.warm_start};
  } else if (!arguments.checkpoint.resume.empty()) {
    earlier_plan = read_resumable(arguments.checkpoint.resume, search, arguments.own_terms, request, task);
    request.warm_start = {.resume = true, .folder = arguments.checkpoint.resume};
  }
  return earlier_plan;
}

/// Hints after a plan is written.
void advise(const PlanArguments& arguments, const PlannedTask& planned, int status, const std::filesystem::path& out) {
  const bool may_go_on = !is_good(planned.record.plan) && (status == kLimit || status == kInterrupted);
  const int reached = planned.record.plan.mesh.num_intervals(), wanted = planned.record.task.mesh.num_intervals();
  if (may_go_on && !refinement_goal(arguments.request, planned.record.task) && reached < wanted) {
    print_note(fmt::format("stopped on a coarse mesh of {} intervals instead of {}; the certificate is for that mesh",
                           reached, wanted));
  }
  if (may_go_on) {
    print_message(fmt::format("to continue from there, repeat the command with --resume {}{}\n", out.string(),
                              arguments.warm_start.empty() ? "" : " instead of --warm-start"));
  }
  if (status == kNotSolved || status == kLimit) {
    print_message(is_good(planned.record.plan)
                      ? "the plan is good, but not as robust as asked: it is kept; what helps: docs/robust.md\n"
                      : fmt::format("to find out why, and what would help: prowl diagnose {}\n", arguments.task));
  }
}

int run_plan(const PlanArguments& arguments) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const PackageSearch search = package_search(arguments.package_dirs);
  Task task = read_task_file(arguments.task, search, arguments.overrides, arguments.own_terms);
  if (arguments.print_phases) return print_phases(task, arguments.json);
  PlanRequest request = arguments.request;
  check_options(request);
  const std::filesystem::path out = arguments.out.empty() ? "out" / std::filesystem::path(task_slug(arguments.task))
                                                          : std::filesystem::path(arguments.out);
  check_plan_directory(out);
  check_step(task, arguments.step);
  note_threads(request.threads);
  for (const std::string& line : implausibilities(task.problem, task.mesh)) print_note(line);

  ProgressPrinter progress;
  progress.watch(request);
  request.interrupt = &interrupted;
  const std::optional<MeshTolerance> tolerance = refinement_goal(request, task);
  request.on_round = [&](const RefineRound& round) { print_progress(in_words(round, *tolerance)); };
  std::optional<ProgressBar> gains;
  request.on_gain = [&](int done, int samples) {
    if (!gains) gains.emplace("gains", samples, ProgressBar::Opening::if_long);
    gains->show(done);
    return true;
  };
  const std::optional<PlanRecord> earlier_plan = read_earlier_plan(arguments, search, task, request);
  if (earlier_plan) request.warm_start.record = &*earlier_plan;
  const auto checkpoints = write_checkpoints(arguments.checkpoint, out, task, request);
  const PlannedTask planned = plan_task(std::move(task), request);
  gains.reset();
  const PlanRecord& record = planned.record;
  if (!planned.why_no_gains.empty()) print_note(planned.why_no_gains);

  if (holds_good_plan(out)) print_note("this replaces an earlier plan that passed, in " + out.string());
  write_plan(out, record, arguments.step);
  if (arguments.report) write_report(record, out, out / kReportFile, search);
  if (!arguments.json)
    print_result(wrap(plan_brief(record, out, columns()) + fmt::format("written to {}\n", out.string())));
  int status = planned.interrupted ? kInterrupted : exit_status(record.plan.result.status, record.plan.certificate);
  if (status == kPassed && record.robustness && !record.robustness->is_full())
    status = planned.robust_is_stopped ? kLimit : kNotSolved;
  advise(arguments, planned, status, out);
  if (arguments.json) {
    print_json({.verb = "plan",
                .exit_status = status,
                .plan = &record,
                .directory = out,
                .written = files_of_plan(out),
                .result = plan_report_json(record, out)});
  }
  return status;
}

}  // namespace

void add_plan_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<PlanArguments>();
  CLI::App* const verb = app.add_subcommand("plan", "Plan the motion of a task file and check it");
  add_task(*verb, arguments->task);
  add_folder(*verb, "--out", arguments->out, "Folder for the result; default out/FOLDER_TASK");
  verb->add_flag("--report", arguments->report, "Also write report.html, which replays the plan in a browser");
  verb->add_flag(
      "--robust", arguments->overrides.robust,
      "Keep margins for errors of start, masses, friction, ground and estimate, and for a push (docs/robust.md)");
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  CLI::Option* const phases = verb->add_flag("--print-phases", arguments->print_phases,
                                             "Print the phases, including those of a gait, without planning");
  add_intervals(*verb, arguments->overrides)->group(kMeshOptions);
  add_refine(*verb, arguments->request.refine);
  verb->add_flag_callback(
          "--one-mesh", [arguments] { arguments->request.coarse_first = false; },
          "Solve on this mesh only, without coarser meshes first")
      ->group(kMeshOptions);
  verb->add_option("--solver", arguments->request.solver, "Solver to use; default " + arguments->request.solver)
      ->check(one_of(solver_names()))
      ->type_name("NAME")
      ->group(kSolverOptions);
  verb->add_option("--threads", arguments->request.threads,
                   fmt::format("Threads for evaluations, not with fatrop; default {}. The result does not depend on it",
                               arguments->request.threads))
      ->check(CLI::Range(1, kMostThreads))
      ->type_name("N")
      ->group(kSolverOptions);
  add_hessian(*verb, arguments->request.hessian);
  add_solver_limits(*verb, arguments->overrides);
  add_folder(*verb, "--warm-start", arguments->warm_start,
             "Start from the plan in this folder, with the same robot and phases; goal, mesh and limits may differ")
      ->group(kSolverOptions);
  add_checkpoint(*verb, arguments->checkpoint);
  verb->get_option("--resume")->excludes("--warm-start");
  verb->add_option("--dt", arguments->step, "Also write trajectory_uniform.csv with this time between samples")
      ->check(number_in(NumberRange::positive()))
      ->type_name("S")
      ->group(kOutputOptions);
  verb->add_flag_callback(
          "--no-gains", [arguments] { arguments->request.gains = false; },
          "Do not write tracker.bin, the feedback gains")
      ->group(kOutputOptions);
  add_json(*verb, arguments->json);
  for (const char* unused : {"--out", "--dt", "--solver", "--max-time", "--max-iterations", "--one-mesh", "--refine",
                             "--no-gains", "--report", "--checkpoint", "--resume"}) {
    phases->excludes(unused);
  }
  set_footer(*verb,
             {"prowl plan tasks/hyq/crouch.toml", "prowl plan tasks/hyq/balance.toml --print-phases",
              "prowl plan tasks/hyq/stand.toml --intervals 40 --dt 0.001 --out out/stand",
              "prowl plan tasks/hyq/crouch.toml --warm-start out/hyq_crouch --intervals 120",
              "prowl plan tasks/hyq/crouch.toml --checkpoint out/so_far --checkpoint-every 0",
              "prowl plan tasks/hyq/crouch.toml --resume out/so_far", "prowl plan tasks/hyq/step.toml --refine",
              "prowl plan tasks/hyq/step.toml --robust", "prowl plan tasks/hyq/crouch.toml --refine certified"},
             "0 the plan passes its certificate; 2 bad input; 3 infeasible, less robust than asked, or solver failed; "
             "4 files; 5 numerical failure; 6 limit of time or iterations; 7 converged but the certificate fails; 130 "
             "interrupted (Ctrl-C keeps the best motion so far, marked as unfinished).");
  verb->callback([arguments, &status] { status = run_plan(*arguments); });
}

}  // namespace prowl::cli

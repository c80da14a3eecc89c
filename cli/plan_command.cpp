#include <fmt/format.h>

#include <memory>
#include <optional>

#include "checkpoint_option.hpp"
#include "commands.hpp"
#include "environment.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "json_result.hpp"
#include "output.hpp"
#include "progress.hpp"
#include "progress_bar.hpp"
#include "prowl/error.hpp"
#include "prowl/feasibility/plausibility.hpp"
#include "prowl/io/phase_table.hpp"
#include "prowl/io/plan_brief.hpp"
#include "prowl/io/plan_directory.hpp"
#include "prowl/io/report_file.hpp"
#include "prowl/io/trajectory_csv.hpp"
#include "prowl/io/warm_start.hpp"
#include "prowl/solvers/ipopt_solver.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "refine_option.hpp"
#include "shared_options.hpp"
#include "wrap.hpp"

namespace prowl::cli {
namespace {

struct PlanArguments {
  std::string task;
  std::string out;
  std::string warm_start;
  std::string solver = solver_names().front();
  std::vector<std::string> package_dirs;
  TaskOverrides overrides;
  std::optional<double> step;  ///< [s]
  std::optional<MeshTolerance> refine;
  CheckpointArguments checkpoint;
  bool json = false;
  bool print_phases = false;
  bool one_mesh = false;
  int threads = 1;
  HessianKind hessian = HessianKind::exact;
  bool no_gains = false;
  bool report = false;
};

constexpr int kMostThreads = 256;

/// The motion of --warm-start, once it is known to fit.
Trajectory read_start(const PlanArguments& arguments, const DiscreteProblem& asked) {
  const PlanRecord record = read_plan(arguments.warm_start, package_search(arguments.package_dirs));
  try {
    return warm_start(record, asked);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--warm-start {}: {}", arguments.warm_start, error.what()));
  }
}

/// Gains for a plan that is good; why there are none is a note, for the plan is as good without.
void add_feedback(PlanRecord& record) {
  if (!is_good(record.plan)) return;
  const MotionProblem& problem = record.task.problem;
  try {
    const std::vector<ReferencePhase> grid = reference_grid(problem, record.plan.trajectory, record.task.tracking.step);
    std::size_t samples = 0;
    for (const ReferencePhase& phase : grid) samples += phase.samples.size();
    ProgressBar bar("gains", static_cast<int>(samples), ProgressBar::Start::if_long);
    int done = 0;
    record.feedback =
        design_feedback(problem, record.plan.trajectory, record.task.tracking, [&](const ReducedSample& sample) {
          if (sample.phase < std::ssize(grid)) bar.show(++done);  // the phase of standing on is one more
        });
  } catch (const NumericalError& error) {
    print_note(error.what());
  }
}

/// A line for each mesh on stderr.
Plan make_refined(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options,
                  const MeshTolerance& tolerance, bool& was_interrupted) {
  RefineOptions refine{.tolerance = tolerance};
  refine.on_round = [&](const RefineRound& round) { print_progress(in_words(round, tolerance)); };
  RefinedPlan refined = make_refined_plan(asked, solver, options, refine);
  was_interrupted = refined.interrupted;
  return std::move(refined.plan);
}

/// Those of its files that a new plan's folder has.
std::vector<std::filesystem::path> files_of_plan(const std::filesystem::path& directory) {
  std::vector<std::filesystem::path> files;
  for (const char* name : {"plan.json", "trajectory.csv", "trajectory_uniform.csv", "tracker.bin", kReportFile}) {
    if (std::filesystem::exists(directory / name)) files.push_back(directory / name);
  }
  return files;
}

int run_plan(const PlanArguments& arguments) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  Task task = read_task_file(arguments.task, package_search(arguments.package_dirs), arguments.overrides);
  if (arguments.print_phases) {
    if (arguments.json) {
      print_json({.verb = "plan", .result = phases_json({task.problem, task.mesh})});
    } else {
      print_result(phase_table({task.problem, task.mesh}));
    }
    return kPassed;
  }
  if (arguments.solver == "fatrop" && arguments.threads > 1) {
    throw InputError("--threads: Fatrop evaluates one stage at a time; leave it out, or take another --solver");
  }
  const std::filesystem::path out = arguments.out.empty() ? "out" / std::filesystem::path(task_slug(arguments.task))
                                                          : std::filesystem::path(arguments.out);
  check_plan_directory(out);
  double duration = 0.0;
  for (const Phase& phase : task.problem.phases) duration += phase.duration.max;
  if (arguments.step && duration / *arguments.step > kMostUniformSamples) {
    throw InputError(fmt::format("--dt: {} s is too fine for a motion of {} s", *arguments.step, duration));
  }

  for (const std::string& line : implausibilities({task.problem, task.mesh})) print_note(line);
  ProgressPrinter progress;
  PlanOptions options{.solver = task.solver};
  progress.watch(options);
  options.solver.interrupt = &interrupted;
  const IpoptSolver hint_solver;
  options.hint_solver = &hint_solver;
  options.coarse_first = !arguments.one_mesh;
  options.solver.threads = arguments.threads;
  options.hessian = arguments.hessian;
  if (!arguments.warm_start.empty()) {
    options.start_from = read_start(arguments, {task.problem, task.mesh});
  }
  std::optional<PlanRecord> resumed =
      resume(arguments.checkpoint, package_search(arguments.package_dirs), arguments.refine.has_value(), task, options);
  const std::string start = arguments.warm_start + arguments.checkpoint.resume;  // one of them, or none
  PlanRecord so_far{.task = task, .plan = {}, .versions = versions(), .warm_start = start};
  if (resumed) {
    so_far.plan = std::move(resumed->plan);
  }
  const auto checkpoints = write_checkpoints(arguments.checkpoint, out, std::move(so_far), options);
  bool was_interrupted = false;
  const auto solver = make_solver(arguments.solver);
  const DiscreteProblem asked(task.problem, task.mesh);
  Plan plan = arguments.refine ? make_refined(asked, *solver, options, *arguments.refine, was_interrupted)
                               : make_plan(asked, *solver, options);

  PlanRecord record{.task = std::move(task),
                    .plan = std::move(plan),
                    .versions = versions(),
                    .feedback = {},
                    .iterations = progress.iterations(),
                    .warm_start = start};
  if (!arguments.no_gains) add_feedback(record);
  if (holds_good_plan(out)) print_note("replaces an earlier plan that passed, in " + out.string());
  write_plan(out, record, arguments.step);
  if (arguments.report) write_report(record, out, out / kReportFile, package_search(arguments.package_dirs));
  if (!arguments.json) print_result(wrap(plan_brief(record, out) + fmt::format("written to {}\n", out.string())));
  const int status = was_interrupted ? kInterrupted : exit_status(record.plan.result.status, record.plan.certificate);
  const bool may_go_on = !is_good(record.plan) && (status == kLimit || status == kInterrupted);
  const int reached = record.plan.mesh.num_intervals(), wanted = record.task.mesh.num_intervals();
  if (may_go_on && !arguments.refine && reached < wanted) {
    print_note(fmt::format("stopped on a coarse mesh, of {} intervals in place of {}; the certificate is of that one",
                           reached, wanted));
  }
  if (may_go_on)
    print_message(fmt::format("to go on from there: --resume {}{}, all else as before\n", out.string(),
                              arguments.warm_start.empty() ? "" : " in place of --warm-start"));
  if (status == kNotSolved || status == kLimit) {
    print_message(fmt::format("why, and what would change that: prowl diagnose {}\n", arguments.task));
  }
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
  verb->add_option("task", arguments->task, "Task file (docs/task-file.md)")->required()->type_name("TASK.toml");
  add_folder(*verb, "--out", arguments->out, "Folder for the result; default out/FOLDER_TASK");
  add_json(*verb, arguments->json);
  verb->add_option("--dt", arguments->step, "Also write trajectory_uniform.csv, sampled every so many seconds")
      ->check(positive_number())
      ->type_name("S");
  verb->add_option("--solver", arguments->solver, "Who solves it; default " + arguments->solver)
      ->check(CLI::IsMember(solver_names()))
      ->type_name("NAME");
  verb->add_option("--threads", arguments->threads,
                   "Threads that evaluate the problem, not with fatrop; default 1. The result is the same")
      ->check(CLI::Range(1, kMostThreads))
      ->type_name("N");
  add_hessian(*verb, arguments->hessian);
  add_solver_limits(*verb, arguments->overrides);
  verb->add_option("--intervals", arguments->overrides.intervals,
                   "Mesh intervals in all, shared out over the phases as in the task file")
      ->check(CLI::Range(1, kMostIntervals))
      ->type_name("N");
  add_refine(*verb, arguments->refine);
  verb->add_flag("--no-gains", arguments->no_gains, "Leave out the feedback gains, tracker.bin");
  verb->add_flag("--report", arguments->report, "Also write report.html, which replays it in a browser");
  verb->add_flag("--one-mesh", arguments->one_mesh, "Solve on this mesh at once, not on coarser ones first");
  add_folder(*verb, "--warm-start", arguments->warm_start,
             "Start from the plan in this folder: of the same robot and phases; goal, mesh and limits may differ");
  add_checkpoint(*verb, arguments->checkpoint);
  verb->get_option("--resume")->excludes("--warm-start");
  add_package_dirs(*verb, arguments->package_dirs);
  CLI::Option* const phases = verb->add_flag("--print-phases", arguments->print_phases,
                                             "Print the phases, those of a gait too, and plan nothing");
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
              "prowl plan tasks/hyq/crouch.toml --refine certified"},
             "0 the plan passes its certificate; 2 bad input; 3 infeasible or solver failed; 4 files;\n"
             "5 numerical failure; 6 limit of time or iterations; 7 converged but the certificate fails;\n"
             "130 interrupted (Ctrl-C keeps the best motion so far, marked as not finished).");
  verb->callback([arguments, &status] { status = run_plan(*arguments); });
}

}  // namespace prowl::cli

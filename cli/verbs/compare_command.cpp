#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>

#include "alternatives/compare_table.hpp"
#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "cli/verbs/commands.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/session/environment.hpp"
#include "prowl/session/equal_steps.hpp"
#include "prowl/solvers/foreign/snopt_solver.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/task_file/task_file.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;
using Names = std::vector<std::string>;

struct CompareArguments {
  std::string task, out;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  Names dynamics, transcriptions, contacts, orientations, solvers;  ///< empty: the first of all
  std::optional<std::string> snopt_library;
  std::string guess = guess_names().front();
  std::vector<int> intervals;  ///< empty: as in the task file
  TaskOverrides overrides;
  HessianKind hessian = HessianKind::exact;
  bool json = false;
};

constexpr const char* kAll = "all";
constexpr const char* kSnopt = "snopt";
constexpr const char* kCompared = "Compared";  ///< group of --help

/// Solvers of prowl plan, and SNOPT, which Prowl does not contain.
Names all_solver_names() {
  Names names = solver_names();
  names.push_back(kSnopt);
  return names;
}

/// SNOPT from the user's library, by default libsnopt7.so. Throws InputError with the remedy if it
/// is unusable.
std::unique_ptr<NlpSolver> make_snopt(const std::optional<std::string>& library) {
  auto snopt = library ? std::make_unique<SnoptSolver>(*library) : std::make_unique<SnoptSolver>();
  const std::optional<std::string>& reason = snopt->why_unavailable();
  if (!reason) return snopt;
  if (library) throw InputError("--snopt-library: " + *reason);
  throw InputError(*reason + "; name it: --snopt-library FILE, or use prowl.snopt in Python (docs/solvers.md#snopt)");
}

std::unique_ptr<NlpSolver> solver_of(const CompareArguments& arguments, const std::string& name) {
  return name == kSnopt ? make_snopt(arguments.snopt_library) : make_solver(name);
}

/// Requested names; by default the first, with "all" all.
Names chosen(const Names& asked, const Names& there_is) {
  if (asked.empty()) return {there_is.front()};
  return std::ranges::find(asked, kAll) == asked.end() ? asked : there_is;
}

/// All combinations on one mesh.
std::vector<ComparedRun> combinations(const CompareArguments& arguments, const Mesh& mesh) {
  std::vector<ComparedRun> lines;
  const int intervals = mesh.num_intervals(), nodes = mesh.num_nodes();
  for (const std::string& dynamics : chosen(arguments.dynamics, dynamics_names()))
    for (const std::string& transcription : chosen(arguments.transcriptions, transcription_names()))
      for (const std::string& contact : chosen(arguments.contacts, contact_names()))
        for (const std::string& orientation : chosen(arguments.orientations, orientation_names()))
          for (const std::string& solver : chosen(arguments.solvers, all_solver_names()))
            lines.push_back({{dynamics, transcription, contact, orientation}, solver, intervals, nodes});
  return lines;
}

/// The task on each mesh.
std::vector<Task> read_tasks(const CompareArguments& arguments) {
  const PackageSearch search = package_search(arguments.package_dirs);
  if (arguments.intervals.empty()) {
    Task task = read_task_file(arguments.task, search, arguments.overrides, arguments.own_terms);
    if (!task.has_intervals) {
      task.mesh = equal_steps_for_draft(task);
      print_note(fmt::format("on {} intervals, with which the trapezoid meets grade draft", task.mesh.num_intervals()));
    }
    return {std::move(task)};
  }
  std::vector<Task> tasks;
  for (const int intervals : arguments.intervals) {
    TaskOverrides overrides = arguments.overrides;
    overrides.intervals = intervals;
    tasks.push_back(read_task_file(arguments.task, search, overrides, arguments.own_terms));
  }
  return tasks;
}

/// A combination that cannot run becomes a table row with the reason.
void run_comparison(const CompareArguments& arguments, const DiscreteProblem& discrete, const SolverOptions& options,
                    ComparedRun& line) {
  try {
    line.run = run_formulation(discrete, line.formulation, *solver_of(arguments, line.solver), options,
                               arguments.hessian, arguments.guess);
  } catch (const Error& error) {
    line.reason = error.what();
  }
}

bool was_interrupted(const ComparedRun& line) {
  return line.run && line.run->result.status == SolveStatus::interrupted;
}

/// Runs all combinations, until Ctrl-C.
CompareRecord compare(const CompareArguments& arguments, const std::atomic<bool>& interrupted) {
  const std::vector<Task> tasks = read_tasks(arguments);
  const Task& task = tasks.front();
  CompareRecord record{.task = task.problem.name,
                       .robot = task.problem.robot.name(),
                       .options = task.solver,
                       .hessian = arguments.hessian,
                       .guess = arguments.guess,
                       .versions = versions()};
  for (const std::string& name : chosen(arguments.solvers, all_solver_names())) {
    if (const auto solver = make_solver_if_installed(name)) record.versions[solver->name()] = solver->version();
  }
  record.options.interrupt = &interrupted;
  std::deque<DiscreteProblem> problems;
  std::vector<std::pair<const DiscreteProblem*, ComparedRun>> lines;
  for (const Task& on_mesh : tasks) {
    problems.emplace_back(on_mesh.problem, on_mesh.mesh);
    for (ComparedRun& line : combinations(arguments, on_mesh.mesh)) {
      lines.emplace_back(&problems.back(), std::move(line));
    }
  }
  record.asked = static_cast<int>(lines.size());
  ProgressBar bar("runs", record.asked);
  for (auto& [problem, line] : lines) {
    bar.show(static_cast<int>(record.runs.size()));
    run_comparison(arguments, *problem, record.options, line);
    if (was_interrupted(line)) break;
    record.runs.push_back(std::move(line));
    if (interrupted) break;
  }
  if (!interrupted) bar.show(record.asked);
  return record;
}

/// Throws InputError if no combination can run.
void check_any_ran(const CompareRecord& record) {
  if (std::ranges::any_of(record.runs, [](const ComparedRun& line) { return line.run.has_value(); })) return;
  const std::string& reason = record.runs.front().reason;
  if (record.asked == 1) throw InputError("this combination cannot be run: " + reason);
  throw InputError(fmt::format("none of {} combinations can be run; the first: {}", record.asked, reason));
}

int run_compare(const CompareArguments& arguments) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const fs::path out =
      arguments.out.empty() ? "out" / fs::path(task_slug(arguments.task) + "_compare") : fs::path(arguments.out);
  const std::set<std::string> names = {"compare.md", "compare.csv", "compare.json"};
  check_replaceable(out, names);
  const CompareRecord record = compare(arguments, interrupted);
  if (record.runs.empty()) {
    const char* const message = "interrupted before the first run was finished; nothing written";
    print_message(fmt::format("{}\n", message));
    if (arguments.json) print_json_error("compare", kInterrupted, message);
    return kInterrupted;
  }
  check_any_ran(record);
  const std::string table = compare_markdown(record), json = compare_json(record);
  write_folder_atomically(out, {{"compare.md", table}, {"compare.csv", compare_csv(record)}, {"compare.json", json}},
                          names);
  const int status = record.interrupted() ? kInterrupted : kPassed;
  if (arguments.json) {
    std::vector<fs::path> written;
    for (const std::string& name : names) written.push_back(out / name);
    print_json({.verb = "compare", .exit_status = status, .written = written, .result = json});
  } else {
    print_result(fmt::format("{}\nwritten to {}\n", table, out.string()));
  }
  return status;
}

void add_names(CLI::App& verb, const char* option, Names& asked, const Names& there_is, const std::string& meaning) {
  Names allowed = there_is;
  allowed.push_back(kAll);
  verb.add_option(option, asked, fmt::format("{}, comma-separated; default {}", meaning, there_is.front()))
      ->check(one_of(allowed))
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->take_all()
      ->group(kCompared);
}

}  // namespace

void add_compare_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<CompareArguments>();
  CLI::App* const verb = app.add_subcommand("compare", "Solve a task in several ways and tabulate the results");
  add_task(*verb, arguments->task);
  add_names(*verb, "--formulation", arguments->dynamics, dynamics_names(),
            "Forms of the dynamics (docs/formulations.md)");
  add_names(*verb, "--transcription", arguments->transcriptions, transcription_names(), "Integration rules");
  add_names(*verb, "--contact", arguments->contacts, contact_names(), "Forms of the contact constraint");
  add_names(*verb, "--orientation", arguments->orientations, orientation_names(),
            "Coordinates of the base orientation");
  add_names(*verb, "--solver", arguments->solvers, all_solver_names(), "Solvers");
  verb->add_option("--intervals", arguments->intervals,
                   "Numbers of mesh intervals, divided among the phases as in the task file; comma-separated")
      ->check(interval_count())
      ->type_name("LIST")
      ->delimiter(',')
      ->expected(1)
      ->take_all()
      ->group(kCompared);
  add_solver_limits(*verb, arguments->overrides);
  add_hessian(*verb, arguments->hessian);
  verb->add_option("--guess", arguments->guess,
                   "Initial guess of all runs: smooth (default), or straight lines from posture to posture")
      ->check(one_of(guess_names()))
      ->type_name("NAME")
      ->group(kSolverOptions);
  verb->add_option("--snopt-library", arguments->snopt_library,
                   "Your own SNOPT, for --solver snopt; default libsnopt7.so")
      ->type_name("FILE")
      ->group(kSolverOptions);
  verb->add_option_function<std::string>(
          "--python",
          [](const std::string&) { print_note("--python is ignored: Drake's SNOPT is prowl.snopt in Python"); },
          "Ignored: Drake's SNOPT is prowl.snopt in Python (docs/solvers.md#snopt)")
      ->type_name("PATH")
      ->group(kSolverOptions);
  add_folder(*verb, "--out", arguments->out, "Folder for compare.md, .csv and .json; default out/FOLDER_TASK_compare");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  set_footer(*verb,
             {"prowl compare tasks/hyq/hold.toml --solver riccati,ipopt",
              "prowl compare tasks/hyq/hold.toml --solver all --intervals 5,10,20"},
             "0 if all ran; the table tells the results; 2 bad input, also if no combination can be run; 4 files; 130 "
             "interrupted (Ctrl-C keeps the runs that have finished).");
  verb->callback([arguments, &status] { status = run_compare(*arguments); });
}

}  // namespace prowl::cli

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>
#include <numbers>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/mpc_benchmark.hpp"
#include "cli/verbs/mpc_view.hpp"
#include "cli/verbs/python_verb.hpp"
#include "cli/verbs/report_page.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/files/csv_table.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/online/online_json.hpp"
#include "prowl/online/online_run.hpp"
#include "prowl/online/random_events.hpp"
#include "prowl/online/script_file.hpp"
#include "prowl/report_page/online_page.hpp"
#include "prowl/session/environment.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "screen/online_summary.hpp"

namespace prowl::cli {
namespace {

constexpr const char* kWorld = "World";  ///< group of --help
constexpr const char *kPages = "Pages", *kBenchmark = "Benchmark";
constexpr double kPageRate = 30.0;  ///< of the moments that a page shows [Hz]
constexpr double kViewed = 600.0;   ///< duration of --view without --duration [s]

struct MpcArguments {
  std::string robot;
  std::vector<std::string> package_dirs;
  OnlineOptions options;
  std::vector<double> command{0.0, 0.0, 0.0};
  std::vector<double> push;      ///< time, impulse in x, y, z
  double kicks = 0.0;            ///< [m/s]
  double random_commands = 0.0;  ///< [m/s] and [rad/s]
  std::string script, save_times, replay_times, page;
  bool view = false, foxglove = false;
  std::string python = default_python();  ///< for --foxglove
  std::uint16_t port = 0;
  MpcBenchmark benchmark;
  double slope = 0.0;  ///< [degrees]
  double budget_ms = 1e3 * OnlineOptions{}.budget, period_ms = 1e3 * OnlineOptions{}.period;
  double delay_ms = 1e3 * SimulationOptions{}.delay;
  std::optional<double> friction;
  std::string late = "act";
  bool json = false;
};

/// One line a plan: its computing time [s].
constexpr const char* kTimesColumn = "plan_s";

void write_times(const std::string& file, const std::vector<double>& times) {
  write_file_atomically(file, fmt::format("{}\n{}\n", kTimesColumn, fmt::join(times, "\n")));
}

std::vector<double> read_times(const std::string& file) {
  const CsvTable table = read_csv_table(read_text_file(file, kLongestTable));
  const auto column = table.values.row(table.index(kTimesColumn));
  const auto negative = std::ranges::find_if(column, [](double seconds) { return seconds < 0.0; });
  if (negative != column.end())
    throw InputError(fmt::format("{}:{}: {}: {:g} is not allowed; need a time >= 0 s", file,
                                 2 + (negative - column.begin()), kTimesColumn, *negative));
  return {column.begin(), column.end()};
}

/// What all runs have in common: controller and world.
OnlineOptions base_options(const RobotModel& robot, const MpcArguments& arguments, const PackageSearch& search) {
  OnlineOptions options = arguments.options;
  options.budget = 1e-3 * arguments.budget_ms;
  options.period = 1e-3 * arguments.period_ms;
  options.simulation.delay = 1e-3 * arguments.delay_ms;
  options.simulation.physics.friction = arguments.friction;
  options.simulation.physics.collisions = collision_shapes(robot, search);
  options.simulation.ground.tilt.y() = -arguments.slope * std::numbers::pi / 180.0;  // ahead the ground rises
  options.late = late_plans_named(arguments.late);
  return options;
}

void add_events(const RobotModel& robot, const MpcArguments& arguments, OnlineOptions& options) {
  options.simulation.pushes = read_pushes(arguments.push, Push{}.duration);
  if (!arguments.script.empty()) {
    add_script(read_script(read_text_file(arguments.script)), options);
  } else if (arguments.random_commands > 0.0) {
    add_random_commands(arguments.random_commands, options);
  } else if (const std::vector<double>& velocity = arguments.command; velocity != std::vector<double>(3, 0.0)) {
    options.commands.push_back({kFirstCommand, {velocity[0], velocity[1], velocity[2], 0.0}, {}});
  }
  if (arguments.kicks > 0.0) add_kicks(robot, arguments.kicks, options);
  if (!arguments.replay_times.empty() && options.late == LatePlans::act)
    throw InputError("--replay-times needs --late drop or wait: otherwise times of plans change nothing");
  if (!arguments.replay_times.empty()) options.replayed_times = read_times(arguments.replay_times);
}

void write_page(const RobotModel& robot, const MpcArguments& arguments, const OnlineOptions& options,
                const OnlineResult& result, const PackageSearch& search) {
  std::vector<std::string> warnings;
  const std::string html =
      online_page({robot, options, result, page_without_data("online"), PageState::file}, search, warnings);
  print_warnings(warnings);
  write_file_atomically(arguments.page, html);
  print_message(fmt::format("page: {}, {:.1f} MB\n", arguments.page, 1e-6 * static_cast<double>(html.size())));
}

/// Throws InputError before a run whose results would be lost.
void check_folder_of(const char* option, const std::string& file) {
  if (file.empty()) return;
  const std::filesystem::path folder = std::filesystem::absolute(file).parent_path();
  std::error_code ignored;
  if (!std::filesystem::is_directory(folder, ignored))
    throw InputError(fmt::format("{}: there is no folder {}", option, folder.string()));
}

OnlineResult run_until_interrupted(const RobotModel& robot, const OnlineOptions& options) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  MotionProgress progress;
  return run_online(robot, options, [&](OnlineMoment& at) {
    progress(at.time, at.end);
    at.stops = interrupted;
  });
}

int run_mpc(const MpcArguments& arguments) {
  check_mujoco();
  check_folder_of("--page", arguments.page);
  check_folder_of("--save-times", arguments.save_times);
  const PackageSearch search = package_search(arguments.package_dirs);
  const RobotModel robot = load_robot(read_text_file(find_robot(arguments.robot)), search);
  OnlineOptions options = base_options(robot, arguments, search);
  if (!arguments.benchmark.file.empty()) return run_mpc_benchmark(robot, options, arguments.benchmark, arguments.json);
  add_events(robot, arguments, options);
  if (arguments.view || !arguments.page.empty()) options.simulation.record_rate = kPageRate;
  const OnlineResult result =
      arguments.view ? view_online(robot, options, search, arguments.port) : run_until_interrupted(robot, options);
  if (!arguments.save_times.empty()) write_times(arguments.save_times, result.times);
  if (!arguments.page.empty()) write_page(robot, arguments, options, result, search);
  // Ctrl-C is how one leaves the live page.
  const bool is_interrupted = result.end == OnlineResult::End::stopped && !arguments.view;
  const int status = is_interrupted ? kInterrupted : result.success() ? kPassed : kSimulationFailed;
  if (arguments.json) {
    print_json({.verb = "mpc", .exit_status = status, .result = online_json(robot, options, result)});
  } else {
    print_result(wrap(online_summary(robot, options, result)));
  }
  return status;
}

void add_world_options(CLI::App& verb, MpcArguments& arguments) {
  SimulationOptions& simulation = arguments.options.simulation;
  const std::vector<CLI::Option*> all = {
      verb.add_option("--push", arguments.push,
                      "Push the base for 0.1 s: time [s] and impulse [N s], world axes; repeatable")
          ->type_name("T IX IY IZ"),
      verb.add_option(
              "--kicks", arguments.kicks,
              "Push the base every 2 s in a random horizontal direction; impulse: the robot's mass times this speed")
          ->type_name("MPS")
          ->check(number_in(NumberRange::nonnegative())),
      verb.add_option("--friction", arguments.friction,
                      fmt::format("Friction of the ground; default {:g}, which the controller assumes",
                                  arguments.options.mpc.friction))
          ->type_name("X")
          ->check(number_in(NumberRange::positive())),
      verb.add_option("--mass", simulation.physics.mass_scale,
                      "Factor on the mass of the robot, unknown to the controller; default 1")
          ->type_name("X")
          ->check(number_in(NumberRange::positive())),
      verb.add_option("--slope", arguments.slope, "The ground rises ahead by this angle, unknown to the controller")
          ->type_name("DEGREES")
          ->check(number_in({.lower = -30.0, .upper = 30.0})),
      verb.add_option("--noise", simulation.noise_scale, "Factor on the noise of the sensors; default 1")
          ->type_name("X")
          ->check(number_in(NumberRange::nonnegative())),
      verb.add_option("--delay", arguments.delay_ms,
                      fmt::format("Sensor-to-torque delay; default {:g}", arguments.delay_ms))
          ->type_name("MS")
          ->check(number_in({.lower = 0.0, .upper = 50.0})),
      verb.add_flag("--perfect-state", simulation.perfect_state, "Give the controller the true state"),
      verb.add_option("--seed", simulation.seed, fmt::format("Seed of all random numbers; default {}", simulation.seed))
          ->check(whole_number())
          ->type_name("N")};
  for (CLI::Option* const option : all) option->group(kWorld);
}

void add_page_options(CLI::App& verb, MpcArguments& arguments) {
  CLI::Option* const view =
      verb.add_flag("--view", arguments.view, "Run in real time; a page in the browser takes commands and kicks");
  view->group(kPages);
  CLI::Option* const foxglove = verb.add_flag(
      "--foxglove", arguments.foxglove, "Run in real time; Foxglove shows the robot, and its Teleop panel commands it");
  foxglove->excludes(view)->group(kPages);
  for (const char* const other : {"--save-times", "--replay-times", "--push", "--slope"}) foxglove->excludes(other);
  verb.add_option("--port", arguments.port,
                  "Port of 127.0.0.1 for --view, default: any free one; or for --foxglove, default: 8765")
      ->check(port_number())
      ->type_name("N")
      ->group(kPages);
  add_python(verb, arguments.python, "numpy, foxglove-sdk and mcap-ros2-support, for --foxglove");
  verb.add_option("--page", arguments.page, "Write a page that replays the run")
      ->type_name("FILE")
      ->excludes(foxglove)
      ->group(kPages);
}

void add_benchmark_options(CLI::App& verb, MpcArguments& arguments) {
  MpcBenchmark& benchmark = arguments.benchmark;
  CLI::Option* const file = verb.add_option("--benchmark", benchmark.file,
                                            "Run the tables of docs/online-benchmark.md, and keep all runs in this "
                                            "file; those in it are not run again")
                                ->type_name("FILE");
  file->group(kBenchmark);
  // The file has the runs of one controller in the worlds of its rows: options of single runs would mix others in.
  for (CLI::Option* const other : verb.get_options()) {
    if (other != file && other != verb.get_help_ptr() && !other->get_positional()) file->excludes(other);
  }
  const std::vector<CLI::Option*> all = {
      verb.add_option("--rows", benchmark.rows, "Only these rows, with commas between; default: all")
          ->delimiter(',')
          ->type_name("NAMES"),
      verb.add_option("--runs", benchmark.seeds, "Runs of each row at most; default: 1 to 200")
          ->check(whole_number(1, 1000000))
          ->type_name("N"),
      verb.add_option("--first-seed", benchmark.first_seed,
                      fmt::format("Seed of the first run of each row; default {}", benchmark.first_seed))
          ->check(whole_number())
          ->type_name("N"),
      verb.add_option("--jobs", benchmark.jobs, "Runs at a time; default: one per core")
          ->check(whole_number(1, 1000))
          ->type_name("N")};
  for (CLI::Option* const option : all) option->needs(file)->group(kBenchmark);
}

}  // namespace

void add_mpc_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<MpcArguments>();
  CLI::App* const verb =
      app.add_subcommand("mpc", "Control a robot online in MuJoCo: a new plan every 10 ms (docs/mpc.md)");
  verb->add_option("robot", arguments->robot, "Robot file, or a shipped robot such as hyq")
      ->required()
      ->type_name("ROBOT");
  verb->add_option("--gait", arguments->options.gait, "How it steps; default trot")
      ->check(one_of(stepping_gaits()))
      ->type_name("NAME");
  verb->add_option("--command", arguments->command,
                   "Velocity ahead and to the left [m/s], and turn rate [rad/s], from 1 s on; default 0 0 0")
      ->expected(3)
      ->check(number_in({.lower = -kFastestCommand, .upper = kFastestCommand}))
      ->type_name("VX VY YAW");
  verb->add_option("--duration", arguments->options.duration,
                   fmt::format("Simulated time; default {:g}", arguments->options.duration))
      ->type_name("S")
      ->check(number_in({.lower = 0.1, .upper = 1e5}));
  verb->add_option("--period", arguments->period_ms,
                   fmt::format("Time between two plans; default {:g}", arguments->period_ms))
      ->type_name("MS")
      ->check(number_in({.lower = 1.0, .upper = 200.0}));
  verb->add_option("--budget", arguments->budget_ms,
                   fmt::format("Computing time allowed for a plan; default {:g}", arguments->budget_ms))
      ->type_name("MS")
      ->check(number_in({.lower = 0.0, .upper = 200.0}));
  verb->add_option(
          "--late", arguments->late,
          "Plan over budget: act (default) uses it at the end of the budget, reproducible on any machine; drop "
          "loses it; wait uses it when it is ready, and measures the next state then")
      ->check(one_of(late_plans_names()))
      ->type_name("NAME");
  CLI::Option* const script =
      verb->add_option("--script", arguments->script, "Commands, gaits and pushes from a file (docs/mpc.md#a-script)")
          ->type_name("FILE");
  CLI::Option* const random =
      verb->add_option("--random-commands", arguments->random_commands,
                       "Every 1 to 4 s a random command: velocities within X m/s, turn rates within X rad/s")
          ->type_name("X")
          ->check(number_in(NumberRange::nonnegative()));
  CLI::Option* const command = verb->get_option("--command");
  script->excludes(random)->excludes(command);
  random->excludes(command);
  CLI::Option* const save = verb->add_option("--save-times", arguments->save_times,
                                             "Write the computing time of each plan, for --replay-times")
                                ->type_name("FILE");
  verb->add_option("--replay-times", arguments->replay_times,
                   "Take the computing times of plans from this file: repeats a run with --late drop or wait")
      ->type_name("FILE")
      ->excludes(save);
  add_world_options(*verb, *arguments);
  add_page_options(*verb, *arguments);
  add_benchmark_options(*verb, *arguments);
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb, {"prowl mpc hyq --duration 3 --command 0.3 0 0", "prowl mpc go2 --duration 4 --kicks 0.3 --seed 3"},
             "0 success; 8 the robot fell, collided, or did not follow its command; others as prowl plan.");
  verb->callback([arguments, verb, &status] {
    if (arguments->view && verb->get_option("--duration")->count() == 0) arguments->options.duration = kViewed;
    const bool is_served = arguments->view || arguments->foxglove;
    if (!is_served && verb->get_option("--port")->count() > 0) throw InputError("--port needs --view or --foxglove");
    if (arguments->foxglove) {
      PythonVerb shown;
      shown.python = arguments->python;
      shown.json = arguments->json;
      status = run_python_verb(*verb, shown);
    } else {
      status = run_mpc(*arguments);
    }
  });
}

}  // namespace prowl::cli

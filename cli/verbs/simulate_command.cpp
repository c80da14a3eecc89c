#include <fmt/format.h>

#include <cmath>
#include <memory>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/plan_tracker.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/plan_folder/rollout_files.hpp"
#include "prowl/plan_folder/simulation_files.hpp"
#include "prowl/report_page/report_file.hpp"
#include "prowl/session/environment.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "prowl/simulation/perturbations.hpp"
#include "prowl/tracking/displaced_start.hpp"

namespace prowl::cli {
namespace {

// Options of one engine alone are grouped by it, in --help and for check_engine().
constexpr const char* kMujocoOptions = "MuJoCo";
constexpr const char* kRolloutOptions = "Rollout";

struct SimulateArguments {
  std::string directory;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  bool json = false;
  bool report = false;
  std::string engine = "mujoco";
  bool open_loop = false;
  std::optional<double> control_rate;  ///< [Hz]
  double record_rate = kRecordRate;    ///< [Hz]
  // With mujoco.
  SimulationOptions options;
  double delay_ms = 1e3 * SimulationOptions{}.delay;
  std::optional<double> friction;
  std::vector<double> push;  ///< time, impulse in x, y, z
  double push_duration = Push{}.duration;
  std::optional<std::uint64_t> sweep_case;
  std::vector<std::string> only;  ///< kinds of perturbations of that case; empty: all
  // With rollout.
  std::vector<double> base_offset{0.0, 0.0, 0.0};      ///< [m]
  std::vector<double> base_offset_rpy{0.0, 0.0, 0.0};  ///< [rad]
};

void check_engine(const CLI::App& verb, const std::string& engine) {
  const bool rollout = engine == "rollout";
  for (const CLI::Option* option : verb.get_options()) {
    if (option->count() == 0 || option->get_group() != (rollout ? kMujocoOptions : kRolloutOptions)) continue;
    throw InputError(
        fmt::format("{}: not with --engine {}, {}", option->get_name(), engine,
                    rollout ? "which has no sensors, delay, friction, pushes or random numbers; use --engine mujoco"
                            : "which starts as planned; use --engine rollout"));
  }
}

/// Result of a simulation, for stdout.
struct Outcome {
  bool success;
  std::string text, json;
};

Outcome run_mujoco(const SimulateArguments& arguments, const PlanRecord& plan, const Tracker& tracker) {
  check_mujoco();
  SimulationOptions options = arguments.options;
  options.open_loop = arguments.open_loop;
  options.control_rate = arguments.control_rate.value_or(options.control_rate);
  options.record_rate = arguments.record_rate;
  options.delay = 1e-3 * arguments.delay_ms;
  options.physics.collisions = collision_shapes(plan.task.problem.robot, package_search(arguments.package_dirs));
  options.physics.friction = arguments.friction ? arguments.friction : plan.task.simulated_friction;
  options.pushes = read_pushes(arguments.push, arguments.push_duration);
  if (arguments.sweep_case)
    options = perturbed(plan.task.problem, tracker, options, only(arguments.only), *arguments.sweep_case);
  MotionProgress progress;
  const SimulationRecord record{options,
                                simulate(plan.task.problem, tracker, plan.task.success, options, std::ref(progress))};
  write_simulation(arguments.directory, plan, record);
  return {record.result.success(), simulation_summary(plan, record), simulation_json(plan, record)};
}

/// Period of --control-rate [s]; 0: continuous.
double control_step(std::optional<double> rate) {
  if (!rate || *rate == 0.0) return 0.0;
  if (!(*rate >= 10.0 && *rate <= 1e5)) {
    throw InputError(fmt::format("control rate: {} is not allowed; need 10 to 1e5 Hz, or 0: continuous", *rate));
  }
  return 1.0 / *rate;
}

Outcome run_rollout(const SimulateArguments& arguments, const PlanRecord& plan, const Tracker& tracker) {
  constexpr double kSampleStep = 1e-3;  // [s], for errors, torques and forces
  const MotionProblem& problem = plan.task.problem;
  RolloutRecord record;
  record.options = {.closed_loop = !arguments.open_loop,
                    .stand_on = plan.task.success.rest,
                    .control_step = control_step(arguments.control_rate),
                    .sample_step = kSampleStep};
  record.base_offset = Eigen::Vector3d::Map(arguments.base_offset.data());
  record.base_offset_rpy = Eigen::Vector3d::Map(arguments.base_offset_rpy.data());
  record.friction = plan.task.simulated_friction;
  record.record_rate = arguments.record_rate;

  const Eigen::AngleAxisd turn(rotation_from_rpy(record.base_offset_rpy));
  Eigen::Matrix<double, 6, 1> displacement;
  displacement << record.base_offset, turn.angle() * turn.axis();
  const StartState start = displaced_start(problem.robot, tracker, displacement);
  MotionProgress progress;
  record.rollout = rollout(problem.robot, tracker, start.q, start.v, record.options, std::ref(progress));
  record.measures =
      measure_rollout(problem, tracker, record.rollout, tracker.end() + record.options.stand_on, record.friction);
  record.failures = rollout_failures(tracker, record.rollout, record.measures, plan.task.success);
  write_rollout(arguments.directory, plan, tracker, record);
  return {record.failures.empty(), rollout_summary(plan, record), rollout_json(plan, tracker, record)};
}

int run_simulate(const SimulateArguments& arguments) {
  const PlanRecord plan = read_plan(arguments.directory, package_search(arguments.package_dirs), arguments.own_terms);
  const Tracker tracker = read_tracker(arguments.directory, plan.task.problem);
  check_writable(arguments.directory);
  const Outcome outcome =
      arguments.engine == "rollout" ? run_rollout(arguments, plan, tracker) : run_mujoco(arguments, plan, tracker);
  if (!arguments.json) {
    print_result(wrap(outcome.text + fmt::format("written to {}/simulate.json, simulate.csv\n", arguments.directory)));
  }
  const std::filesystem::path directory = arguments.directory;
  std::vector<std::filesystem::path> written = {directory / "simulate.json", directory / "simulate.csv"};
  if (arguments.report) {
    write_report(plan, directory, directory / kReportFile, package_search(arguments.package_dirs));
    written.push_back(directory / kReportFile);
  }
  const int status = outcome.success ? kPassed : kSimulationFailed;
  if (arguments.json) {
    print_json({.verb = "simulate",
                .exit_status = status,
                .plan = &plan,
                .directory = directory,
                .written = written,
                .result = outcome.json});
  }
  return status;
}

void add_mujoco_options(CLI::App& verb, SimulateArguments& arguments) {
  SimulationOptions& options = arguments.options;
  const std::vector<CLI::Option*> all = {
      verb.add_flag("--perfect-state", options.perfect_state,
                    "The controller reads the true state, without sensors and estimator"),
      verb.add_option("--noise", options.noise_scale,
                      fmt::format("Factor on noise and bias of the sensors; default {:g}", options.noise_scale))
          ->type_name("X"),
      verb.add_option("--delay", arguments.delay_ms,
                      fmt::format("Delay from sensors to torques; default {:g}", arguments.delay_ms))
          ->check(number_in({.lower = 0.0, .upper = 1000.0}))
          ->type_name("MS"),
      verb.add_option("--bandwidth", options.bandwidth,
                      fmt::format("Bandwidth of first-order actuators; 0: ideal; default {:g}", options.bandwidth))
          ->type_name("HZ"),
      verb.add_option("--mass", options.physics.mass_scale,
                      fmt::format("Factor on all masses and inertias; default {:g}", options.physics.mass_scale))
          ->type_name("X"),
      verb.add_option("--friction", arguments.friction, "Friction of all surfaces; default: as in the task")
          ->type_name("MU"),
      verb.add_option("--push", arguments.push, "Push the base: time [s] and impulse [N s], world axes; repeatable")
          ->type_name("T IX IY IZ")
          ->expected(4)
          ->take_all(),
      verb.add_option("--push-duration", arguments.push_duration,
                      fmt::format("Duration of every push; default {:g}", arguments.push_duration))
          ->type_name("S")
          ->check(number_in(NumberRange::positive())),
      verb.add_option("--step", options.physics.step,
                      fmt::format("Time step of the physics; default {:g}", options.physics.step))
          ->type_name("S"),
      verb.add_option("--seed", options.seed, fmt::format("Seed of all random numbers; default {}", options.seed))
          ->check(whole_number())
          ->type_name("N"),
      verb.add_option("--case", arguments.sweep_case, "Perturb like this case (seed) of prowl sweep without options")
          ->check(whole_number())
          ->type_name("SEED")};
  for (CLI::Option* const option : all) option->group(kMujocoOptions);
  add_only(verb, arguments.only)->needs(all.back())->group(kMujocoOptions);
  for (const char* drawn : {"--mass", "--friction", "--push", "--push-duration", "--seed"})
    all.back()->excludes(verb.get_option(drawn));
}

void add_rollout_options(CLI::App& verb, SimulateArguments& arguments) {
  const std::vector<CLI::Option*> all = {
      verb.add_option("--base-offset-m", arguments.base_offset,
                      "Start with the base moved by this much, world axes [m], feet in place")
          ->type_name("X Y Z")
          ->expected(3),
      verb.add_option("--base-offset-rad", arguments.base_offset_rpy,
                      "Start with the base turned by this much, its own axes [rad], feet in place")
          ->type_name("ROLL PITCH YAW")
          ->expected(3)};
  for (CLI::Option* const option : all) option->group(kRolloutOptions);
}

}  // namespace

void add_simulate_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<SimulateArguments>();
  CLI::App* const verb =
      app.add_subcommand("simulate", "Run a plan with its feedback in MuJoCo, or in its own dynamics");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--engine", arguments->engine,
                   "mujoco (default): physics with contacts and sensors; rollout: the dynamics of the plan, contacts "
                   "as scheduled")
      ->check(one_of({"mujoco", "rollout"}))
      ->type_name("NAME");
  verb->add_flag("--open-loop", arguments->open_loop, "Apply the planned torques only, without feedback");
  verb->add_option("--control-rate", arguments->control_rate,
                   fmt::format("Rate of the controller; default {:g}; with --engine rollout 0 means continuous",
                               SimulationOptions{}.control_rate))
      ->type_name("HZ");
  verb->add_option("--record-rate", arguments->record_rate,
                   fmt::format("Rows per second in simulate.csv; default {:g}", arguments->record_rate))
      ->type_name("HZ");
  verb->add_flag("--report", arguments->report, "Also write report.html, which replays the run in a browser");
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  add_mujoco_options(*verb, *arguments);
  add_rollout_options(*verb, *arguments);
  add_json(*verb, arguments->json);
  set_footer(*verb,
             {"prowl simulate out/hyq_crouch --report", "prowl simulate out/hyq_crouch --push 0.5 0 10 0",
              "prowl simulate out/hyq_crouch --case 2 --only ground,push",
              "prowl simulate out/hyq_crouch --engine rollout --base-offset-m 0.02 0 0"},
             "0 success, 8 failure by the judge; others as prowl plan.");
  verb->callback([arguments, verb, &status] {
    check_engine(*verb, arguments->engine);
    status = run_simulate(*arguments);
  });
}

}  // namespace prowl::cli

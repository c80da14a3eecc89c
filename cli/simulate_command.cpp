#include <fmt/format.h>

#include <memory>

#include "commands.hpp"
#include "environment.hpp"
#include "exit_status.hpp"
#include "output.hpp"
#include "plan_tracker.hpp"
#include "prowl/io/plan_directory.hpp"
#include "prowl/io/report_file.hpp"
#include "prowl/io/simulation_files.hpp"
#include "prowl/simulation/sweep.hpp"

namespace prowl::cli {
namespace {

struct SimulateArguments {
  std::string directory;
  std::vector<std::string> package_dirs;
  SimulationOptions options;
  double delay_ms = 1e3 * SimulationOptions{}.delay;
  std::optional<double> friction;
  std::vector<double> push;  ///< time, impulse in x, y, z
  double push_duration = 0.1;
  std::optional<std::uint64_t> sweep_case;
  bool json = false;
  bool report = false;
};

int run_simulate(SimulateArguments arguments) {
  const PlanRecord plan = read_plan(arguments.directory, package_search(arguments.package_dirs));
  const Tracker tracker = read_tracker(arguments.directory);
  SimulationOptions& options = arguments.options;
  options.delay = 1e-3 * arguments.delay_ms;
  options.physics.friction = arguments.friction ? arguments.friction : plan.task.simulated_friction;
  for (std::size_t i = 0; i + 3 < arguments.push.size(); i += 4) {
    const double* const push = &arguments.push[i];
    options.pushes.push_back({{push[1], push[2], push[3]}, push[0], arguments.push_duration});
  }
  if (arguments.sweep_case) options = perturbed(tracker, options, {}, *arguments.sweep_case);
  const SimulationRecord record{options, simulate(plan.task.problem, tracker, plan.task.success, options)};
  write_simulation(arguments.directory, plan, record);
  print_result(arguments.json ? simulation_json(plan, record)
                              : simulation_summary(plan, record) +
                                    fmt::format("written to {}/simulate.json, simulate.csv\n", arguments.directory));
  if (arguments.report) {
    const std::filesystem::path directory = arguments.directory;
    write_report(plan, directory, directory / kReportFile, package_search(arguments.package_dirs));
  }
  return record.result.success() ? kPassed : kSimulationFailed;
}

}  // namespace

void add_simulate_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<SimulateArguments>();
  SimulationOptions& options = arguments->options;
  options.record_rate = 200.0;
  CLI::App* const verb = app.add_subcommand("simulate", "Run a plan with its feedback in MuJoCo");
  verb->add_option("directory", arguments->directory, "Folder that prowl plan wrote")->required()->type_name("DIR");
  verb->add_flag("--open-loop", options.open_loop, "Feedforward torques only");
  verb->add_flag("--perfect-state", options.perfect_state, "The controller sees the true state: no sensors, no estimator");
  verb->add_option("--noise", options.noise_scale, "Factor on the sensors' noise and bias; default 1")->type_name("X");
  verb->add_option("--delay", arguments->delay_ms, "From sensors to torque; default 2")->type_name("MS");
  verb->add_option("--bandwidth", options.bandwidth, "Of the actuators, first order; default 0: they follow at once")->type_name("HZ");
  verb->add_option("--control-rate", options.control_rate, "Default 1000")->type_name("HZ");
  verb->add_option("--mass", options.physics.mass_scale, "Factor on all masses and inertias; default 1")->type_name("X");
  verb->add_option("--friction", arguments->friction, "Of all surfaces; default: as in the task")->type_name("MU");
  verb->add_option("--push", arguments->push, "Push the base: time [s] and impulse [N s], world axes; may be given again")
      ->type_name("T IX IY IZ")->expected(4)->take_all();
  verb->add_option("--push-duration", arguments->push_duration, "Of every push; default 0.1")->type_name("S")->check(CLI::PositiveNumber);
  verb->add_option("--step", options.physics.step, "Of the physics; default 0.0005")->type_name("S");
  verb->add_option("--seed", options.seed, "Of all random numbers; default 1")->type_name("N");
  verb->add_option("--case", arguments->sweep_case, "Perturbed as the case of that seed in prowl sweep without options")->type_name("SEED");
  verb->add_option("--record-rate", options.record_rate, "Rows a second in simulate.csv; default 200")->type_name("HZ");
  verb->add_flag("--report", arguments->report, "Also write report.html, which replays it in a browser");
  verb->add_flag("--json", arguments->json, "Print the result as JSON");
  verb->add_option("--package-dir", arguments->package_dirs, "Where to look for package://; may be given again")
      ->type_name("DIR")->expected(1)->take_all();
  verb->footer("Example:\n  prowl simulate out/hyq_crouch --push 0.5 0 10 0\n\n"
               "Exit status: 0 success, 8 failure by the task's criteria; others as prowl plan.");
  verb->callback([arguments, &status] { status = run_simulate(*arguments); });
}

}  // namespace prowl::cli

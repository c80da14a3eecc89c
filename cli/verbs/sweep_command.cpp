#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/interrupt.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/plan_tracker.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/plan_folder/sweep_files.hpp"
#include "prowl/simulation/collision_shapes.hpp"

namespace prowl::cli {
namespace {

constexpr const char* kPerturbations = "Perturbations";  ///< group of --help

struct SweepArguments {
  std::string directory;
  std::vector<std::string> package_dirs;
  OwnTerms own_terms;
  SimulationOptions options;
  PerturbationRanges ranges;
  std::vector<std::string> only;
  int cases = 200;
  std::uint64_t seed = 1;
  int breakdown_cases = 0;
  bool json = false;
};

/// Calls `run` with a progress callback, which is silent after `interrupted`, while running cases
/// finish.
template <typename Run>
auto with_bar(const char* what, const std::atomic<bool>& interrupted, const Run& run) {
  std::optional<ProgressBar> bar;  // its length is known at the first call
  return run([&](int done, int total) {
    if (interrupted) return;
    if (!bar) bar.emplace(what, total);
    bar->show(done);
  });
}

/// Refuses sizes of what --only leaves out.
void check_only(const CLI::App& verb, const std::vector<std::string>& kinds) {
  if (kinds.empty()) return;
  for (const auto& [option, kind] : {std::pair("--mass-spread", "mass"), std::pair("--push-impulse", "push"),
                                     std::pair("--push-impulse-on-two-feet", "push")}) {
    if (verb.get_option(option)->count() > 0 && std::ranges::count(kinds, kind) == 0)
      throw InputError(fmt::format("{}: has no effect, as --only lacks '{}'; need both or none", option, kind));
  }
}

int run_sweep(const SweepArguments& arguments) {
  const PerturbationRanges ranges = only(arguments.only, arguments.ranges);
  check_mujoco();
  const std::atomic<bool>& interrupted = catch_interrupts();
  const PlanRecord plan = read_plan(arguments.directory, package_search(arguments.package_dirs), arguments.own_terms);
  check_writable(arguments.directory);
  const MotionProblem& problem = plan.task.problem;
  const Tracker tracker = read_tracker(arguments.directory, problem);
  SweepRecord record{.first_seed = arguments.seed, .asked = arguments.cases, .ranges = ranges, .only = arguments.only};
  SimulationOptions base = arguments.options;
  base.physics.collisions = collision_shapes(problem.robot, package_search(arguments.package_dirs));
  base.physics.friction = plan.task.simulated_friction;
  std::vector<SimulationOptions> options;
  for (int i = 0; i < arguments.cases; ++i) {
    options.push_back(perturbed(problem, tracker, base, ranges, arguments.seed + static_cast<std::uint64_t>(i)));
  }
  print_progress(fmt::format("{} simulation{} of {:.1f} s of motion{}\n", arguments.cases,
                             arguments.cases == 1 ? "" : "s", tracker.end() + plan.task.success.rest,
                             arguments.breakdown_cases > 0 ? ", then those with a single perturbation" : ""));
  record.cases = with_bar("simulations", interrupted, [&](const SweepProgress& on_done) {
    return run_cases(problem, tracker, plan.task.success, options, on_done, &interrupted);
  });
  if (arguments.breakdown_cases > 0 && !interrupted) {
    record.breakdowns =
        with_bar("simulations of one perturbation alone", interrupted, [&](const SweepProgress& on_done) {
          return find_breakdowns(problem, tracker, plan.task.success, base, arguments.seed, arguments.breakdown_cases,
                                 on_done, &interrupted);
        });
  }
  record.interrupted = interrupted && (std::ssize(record.cases) < arguments.cases || arguments.breakdown_cases > 0);
  if (record.cases.empty()) {
    const char* const message = "interrupted before the first simulation was finished; nothing written";
    print_message(fmt::format("{}\n", message));
    if (arguments.json) print_json_error("sweep", kInterrupted, message);
    return kInterrupted;
  }
  const std::filesystem::path file = std::filesystem::path(arguments.directory) / "sweep.json";
  const std::string json = sweep_json(plan, tracker, record);
  const int status = record.interrupted ? kInterrupted : kPassed;
  write_file_atomically(file, json);
  if (arguments.json) {
    print_json({.verb = "sweep",
                .exit_status = status,
                .plan = &plan,
                .directory = arguments.directory,
                .written = {file},
                .result = json});
  } else {
    print_result(wrap(sweep_summary(plan, tracker, record) + fmt::format("written to {}\n", file.string())));
  }
  return status;
}

}  // namespace

void add_sweep_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<SweepArguments>();
  PerturbationRanges& ranges = arguments->ranges;
  CLI::App* const verb =
      app.add_subcommand("sweep", "Run a plan in MuJoCo many times, each time perturbed differently");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--n", arguments->cases, fmt::format("Number of simulations; default {}", arguments->cases))
      ->type_name("N")
      ->check(CLI::Range(1, 1000000));
  verb->add_option("--seed", arguments->seed,
                   fmt::format("Seed of the first case; the others count up; default {}", arguments->seed))
      ->check(whole_number())
      ->type_name("N");
  add_only(*verb, arguments->only)->group(kPerturbations);
  verb->add_option("--mass-spread", ranges.mass,
                   fmt::format("Largest error of the mass of each body, as a share; default {:g}", ranges.mass))
      ->type_name("X")
      ->check(number_in({.lower = 0.0, .upper = 0.9}))
      ->group(kPerturbations);
  verb->add_option(
          "--push-impulse", ranges.push,
          fmt::format("Impulse of the pushes on the base; default: {:g} m/s times the mass if the robot stands 0.58 m "
                      "high, scaled with the root of its height",
                      ranges.push_velocity))
      ->type_name("NS")
      ->check(number_in(NumberRange::nonnegative()))
      ->group(kPerturbations);
  verb->add_option("--push-impulse-on-two-feet", ranges.push_on_two_feet,
                   "The same while two feet or fewer are on the ground; default: no less")
      ->type_name("NS")
      ->check(number_in(NumberRange::nonnegative()))
      ->group(kPerturbations);
  verb->add_option(
          "--breakdown", arguments->breakdown_cases,
          "Also look for the size at which each perturbation alone breaks the plan, with N simulations for each size")
      ->type_name("N")
      ->check(CLI::Range(0, 100000))
      ->excludes(verb->get_option("--only"))
      ->group(kPerturbations);
  verb->add_flag("--open-loop", arguments->options.open_loop, "Apply the planned torques only, without feedback");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  add_allow_libraries(*verb, arguments->own_terms.allows_libraries);
  set_footer(*verb,
             {"prowl sweep out/hyq_crouch --n 200 --seed 1", "prowl sweep out/hyq_crouch --n 10 --mass-spread 0.2",
              "prowl sweep out/hyq_crouch --n 10 --only ground,push"},
             "0 if all simulations ran, with or without success; 130 interrupted (Ctrl-C keeps the simulations that "
             "have finished).");
  verb->callback([arguments, verb, &status] {
    check_only(*verb, arguments->only);
    status = run_sweep(*arguments);
  });
}

}  // namespace prowl::cli

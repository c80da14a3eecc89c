#include <fmt/format.h>
#include <unistd.h>

#include <memory>

#include "commands.hpp"
#include "environment.hpp"
#include "exit_status.hpp"
#include "interrupt.hpp"
#include "output.hpp"
#include "plan_tracker.hpp"
#include "prowl/io/atomic_folder.hpp"
#include "prowl/io/sweep_files.hpp"

namespace prowl::cli {
namespace {

struct SweepArguments {
  std::string directory;
  std::vector<std::string> package_dirs;
  SimulationOptions options;
  PerturbationRanges ranges;
  int cases = 200;
  std::uint64_t seed = 1;
  int breakdown_cases = 20;
  bool json = false;
};

/// One line that is written over and over in a terminal; elsewhere a line for every tenth.
class Bar {
 public:
  explicit Bar(int total) : total_(total), in_terminal_(::isatty(STDERR_FILENO) == 1) {}
  void show(int done) const {
    constexpr int kWidth = 40;
    const int filled = kWidth * done / total_;
    if (in_terminal_) {
      print_message(fmt::format("\r[{:#<{}}{:.<{}}] {}/{}{}", "", filled, "", kWidth - filled, done, total_,
                                done == total_ ? "\n" : ""));
    } else if (done == total_ || done % std::max(1, total_ / 10) == 0) {
      print_message(fmt::format("{} of {} simulations\n", done, total_));
    }
  }

 private:
  int total_;
  bool in_terminal_;
};

int run_sweep(const SweepArguments& arguments) {
  const std::atomic<bool>& interrupted = catch_interrupts();
  const PlanRecord plan = read_plan(arguments.directory, package_search(arguments.package_dirs));
  const MotionProblem& problem = plan.task.problem;
  const Tracker tracker = read_tracker(arguments.directory, problem);
  SweepRecord record{arguments.seed, arguments.ranges, {}, {}};
  std::vector<SimulationOptions> options;
  for (int i = 0; i < arguments.cases; ++i) {
    options.push_back(perturbed(tracker, arguments.options, arguments.ranges, arguments.seed + static_cast<std::uint64_t>(i)));
  }
  const Bar bar(arguments.cases);
  record.cases = run_cases(problem, tracker, plan.task.success, options, [&](int done) { bar.show(done); }, &interrupted);
  if (arguments.breakdown_cases > 0) {
    SimulationOptions alone = arguments.options;
    alone.physics.friction = plan.task.simulated_friction;
    record.breakdowns = find_breakdowns(problem, tracker, plan.task.success, alone, arguments.seed, arguments.breakdown_cases,
                                        [](const std::string& kind) { print_message("alone: " + kind + " ...\n"); }, &interrupted);
  }
  if (interrupted) return kInterrupted;
  write_file_atomically(std::filesystem::path(arguments.directory) / "sweep.json", sweep_json(plan, tracker, record));
  print_result(arguments.json ? sweep_json(plan, tracker, record)
                              : sweep_summary(plan, tracker, record) + fmt::format("written to {}/sweep.json\n", arguments.directory));
  return kPassed;
}

}  // namespace

void add_sweep_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<SweepArguments>();
  PerturbationRanges& ranges = arguments->ranges;
  CLI::App* const verb = app.add_subcommand("sweep", "Run a plan in MuJoCo many times, each perturbed in another way");
  verb->add_option("directory", arguments->directory, "Folder that prowl plan wrote")->required()->type_name("DIR");
  verb->add_option("--n", arguments->cases, "How many; default 200")->type_name("N")->check(CLI::Range(1, 1000000));
  verb->add_option("--seed", arguments->seed, "Of the first case, the others count on; default 1")->type_name("SEED");
  verb->add_option("--mass", ranges.mass, "Masses are off by up to this share; default 0.1")->type_name("X")->check(CLI::Range(0.0, 0.9));
  verb->add_option("--push", ranges.push, "Impulse on the base; default 10")->type_name("NS")->check(CLI::NonNegativeNumber);
  verb->add_option("--push-on-two-feet", ranges.push_on_two_feet, "While two feet or fewer are down; default 2")->type_name("NS")->check(CLI::NonNegativeNumber);
  verb->add_option("--breakdown", arguments->breakdown_cases,
                   "Simulations for each size of a perturbation alone; default 20, 0: do not look for it")->type_name("N")->check(CLI::Range(0, 100000));
  verb->add_flag("--open-loop", arguments->options.open_loop, "Feedforward torques only");
  verb->add_flag("--json", arguments->json, "Print the result as JSON");
  verb->add_option("--package-dir", arguments->package_dirs, "Where to look for package://; may be given again")
      ->type_name("DIR")->expected(1)->take_all();
  verb->footer("Example:\n  prowl sweep out/hyq_crouch --n 200 --seed 1\n\nExit status: 0 if all were simulated, whatever came of them.");
  verb->callback([arguments, &status] { status = run_sweep(*arguments); });
}

}  // namespace prowl::cli

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <sstream>
#include <string>

#include "cli/options/shared_options.hpp"
#include "cli/process/program_files.hpp"
#include "cli/process/python_script.hpp"
#include "cli/process/work_folder.hpp"
#include "cli/exit_status.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/progress_bar.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/plan_tracker.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/plan_folder/figure_data.hpp"
#include "prowl/plan_folder/figure_files.hpp"
#include "prowl/plan_folder/plan_folder.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kStep = 0.005;                   ///< of contact accelerations [s]
constexpr std::size_t kLongestFigure = 1u << 30;  ///< [bytes]

struct FiguresArguments {
  std::string directory, out, joint, python = default_python();
  std::vector<std::string> package_dirs;
  bool json = false;
};

void draw(const FiguresArguments& arguments, const fs::path& work, const std::string& joint) {
  std::optional<ProgressBar> bar;
  const auto on_line = [&bar](const std::string& line) {
    std::istringstream words(line);
    std::string figures, of;
    int done = 0, total = 0;
    if (!(words >> figures >> done >> of >> total) || figures != "figures" || total < 1) {
      print_message(line + "\n");
      return;
    }
    if (!bar) bar.emplace("figures", total);
    bar->show(done);
  };
  run_script({arguments.python, "numpy, scipy and matplotlib"}, "figures/draw.py",
             {arguments.directory, work.string(), joint}, on_line);
}

/// "--joint" or a default, checked.
int gains_joint(const RobotModel& robot, const std::string& name) {
  return name.empty() ? default_gains_joint(robot) : joint_index(robot, name);
}

int run_figures(const FiguresArguments& arguments) {
  const fs::path directory = arguments.directory;
  const fs::path out = arguments.out.empty() ? directory / kFiguresFolder : fs::path(arguments.out);
  const PlanRecord plan = read_plan(directory, package_search(arguments.package_dirs));
  const MotionProblem& problem = plan.task.problem;
  const Trajectory& trajectory = plan.plan.trajectory;
  const int joint = gains_joint(problem.robot, arguments.joint);
  check_replaceable(out, figure_file_names());

  const WorkFolder work;
  write_file_atomically(work.path() / "contact_acceleration.csv", contact_acceleration_csv(problem, trajectory, kStep));
  write_file_atomically(work.path() / "torque_limits.csv", torque_limits_csv(problem.robot, trajectory));
  if (!problem.robot.torque_curves().empty()) {
    write_file_atomically(work.path() / "limit_curves.csv", limit_curves_csv(problem.robot));
  }
  write_file_atomically(work.path() / "legs.csv", legs_csv(problem.robot));
  std::error_code ignored;
  const bool has_gains = fs::exists(directory / "tracker.bin", ignored);
  if (has_gains) {
    write_file_atomically(work.path() / "gains.csv", gains_csv(problem.robot, read_tracker(directory, problem), joint));
  } else {
    print_message(fmt::format("no gains in {}: without figure gains; prowl plan writes them (tracker.bin)\n",
                              arguments.directory));
  }
  if (!fs::exists(directory / "simulate.csv", ignored)) {
    print_message(fmt::format("no simulation in {}: planned motion only, without base_error and joint_error\n",
                              arguments.directory));
    if (has_gains) print_message(fmt::format("for all figures first\n  prowl simulate {}\n", arguments.directory));
  }
  draw(arguments, work.path(), problem.robot.joint_names()[joint]);

  std::map<std::string, std::string> files;
  std::vector<fs::path> written;
  std::vector<std::string> pictures;
  for (const std::string& name : figure_file_names()) {
    if (!fs::exists(work.path() / name, ignored)) continue;
    files[name] = read_text_file(work.path() / name, kLongestFigure).text;
    written.push_back(out / name);
    if (name.ends_with(".png")) pictures.push_back(name.substr(0, name.size() - 4));
  }
  write_folder_atomically(out, files, figure_file_names());
  if (arguments.json) {
    print_json({.verb = "figures",
                .plan = &plan,
                .directory = directory,
                .written = written,
                .result = json_text({{"figures", pictures}})});
  } else {
    print_result(
        fmt::format("{}\nwritten to {}, each as .svg, .png and .csv\n", fmt::join(pictures, ", "), out.string()));
  }
  return kPassed;
}

}  // namespace

void add_figures_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<FiguresArguments>();
  CLI::App* const verb = app.add_subcommand("figures", "Draw a plan, its gains and its simulation");
  add_plan_directory(*verb, arguments->directory);
  add_folder(*verb, "--out", arguments->out, "Folder for the figures; default: DIR/figures");
  verb->add_option("--joint", arguments->joint,
                   "Whose gains to draw; default: the first knee, or else the first leg's last joint")
      ->type_name("NAME");
  verb->add_option("--python", arguments->python,
                   "Python with numpy, scipy and matplotlib; default " + arguments->python)
      ->type_name("PATH");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb,
             {"prowl simulate out/hyq_crouch && prowl figures out/hyq_crouch",
              "prowl figures out/hyq_crouch --joint lf_hfe_joint --out figures"},
             "0 if they are drawn, 2 bad input, 4 files.");
  verb->callback([arguments, &status] { status = run_figures(*arguments); });
}

}  // namespace prowl::cli

#include <memory>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/screen/wrap.hpp"
#include "cli/verbs/commands.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "screen/robot_summary.hpp"

namespace prowl::cli {
namespace {

struct RobotArguments {
  std::string robot;
  std::vector<std::string> package_dirs;
  bool frames = false;
  bool json = false;
};

int run_robot(const RobotArguments& arguments) {
  const RobotModel robot =
      load_robot(read_text_file(arguments.robot), package_search(arguments.package_dirs), {.needs_contacts = false});
  const RobotInspection inspection = inspect(robot);
  if (arguments.json) {
    print_json({.verb = "robot", .result = robot_report_json(robot, inspection)});
  } else {
    print_result(wrap(robot_summary(robot, inspection)) + (arguments.frames ? frame_list(robot) : ""));
  }
  return kPassed;
}

}  // namespace

void add_robot_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<RobotArguments>();
  CLI::App* const verb = app.add_subcommand("robot", "Show a robot as Prowl reads it, with warnings");
  verb->add_option("robot", arguments->robot, "Robot file (docs/robot-file.md)")->required()->type_name("ROBOT.toml");
  verb->add_flag("--frames", arguments->frames, "Also list the frames that may carry contacts");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb, {"prowl robot robots/hyq.toml", "prowl robot new.toml --frames     for a file without contacts"},
             "0, 2 bad input, 4 files.");
  verb->callback([arguments, &status] { status = run_robot(*arguments); });
}

}  // namespace prowl::cli

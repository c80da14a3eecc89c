// A command with verbs of verbs and with texts that mean something to shells, for completion_test: prowl completion
// SHELL.
#include "cli/verbs/commands.hpp"

int main(int argc, char** argv) {
  int status = 0;
  CLI::App app("Not prowl.", "prowl");
  CLI::App* const make = app.add_subcommand("new", "Write a file: 'robot' or [task]; $(touch mistake) `touch mistake`");
  make->require_subcommand(1);
  CLI::App* const robot = make->add_subcommand("robot", "It's a robot: $HOME \"new\"");
  std::string text;
  bool flag = false;
  robot->add_option("urdf", text, "URDF")->required()->type_name("URDF");
  robot->add_option("--feet", text, "Where [they] are: it's 'point' or \"flat\" $(touch mistake)")
      ->check(CLI::IsMember({"point", "flat"}))
      ->type_name("KIND");
  CLI::App* const task = make->add_subcommand("task", "A task");
  task->add_option("robot", text, "Robot file")->required()->type_name("ROBOT.toml");
  task->add_flag("--force", flag, "Over a file that is there");
  CLI::App* const top = app.add_subcommand("robot", "Same name, another verb");
  top->add_option("robot", text, "Robot file")->required()->type_name("ROBOT.toml");
  top->add_flag("--frames", flag, "List them");
  prowl::cli::add_completion_command(app, status);
  CLI11_PARSE(app, argc, argv);
  return status;
}

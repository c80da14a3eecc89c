#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <memory>
#include <nlohmann/json.hpp>

#include "cli/options/shared_options.hpp"
#include "cli/process/exit_status.hpp"
#include "cli/process/program_files.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/new_file.hpp"
#include "prowl/error.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/mjcf/mjcf_robot.hpp"
#include "prowl/model/robot_inspection.hpp"
#include "prowl/starter/new_task.hpp"
#include "prowl/starter/packaged_robots.hpp"
#include "prowl/starter/robot_template.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "prowl/task_file/task_file.hpp"
#include "screen/robot_summary.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

struct NewRobotArguments {
  std::string source;
  std::vector<std::string> package_dirs;
  NewFileOptions file;
  bool json = false;
};

/// "Talos v2" -> "talos_v2".
std::string file_stem(const std::string& name) {
  std::string stem;
  for (const char c : name) {
    const auto letter = static_cast<unsigned char>(c);
    if (std::isalnum(letter) != 0)
      stem += static_cast<char>(std::tolower(letter));
    else if (!stem.empty() && stem.back() != '_')
      stem += '_';
  }
  while (stem.ends_with('_')) stem.pop_back();
  return stem.empty() ? "robot" : stem;
}

/// Throws InputError with the nearest packaged robot if the file does not exist.
fs::path source_path(const std::string& text, const PackageSearch& search) {
  std::error_code unknown;  // reported by the reader
  if (text.find("://") == std::string::npos) {
    if (!fs::exists(text, unknown) && !unknown)
      throw InputError(fmt::format("{}: no such file{}", text, nearest_packaged_robot(text, search)));
    return text;
  }
  try {
    return resolve_uri(text, fs::current_path() / "robot.toml", {}, search);
  } catch (const InputError& error) {
    const std::string nearest =
        text.starts_with("package://example-robot-data/") ? nearest_packaged_robot(text, search) : "";
    throw InputError(nearest.empty() ? fmt::format("{}: {}", text, error.what())
                                     : fmt::format("{}: not found{}", text, nearest));
  }
}

fs::path robot_file_path(const NewRobotArguments& arguments, const std::string& name) {
  return arguments.file.out.empty() ? fs::path("robots") / (file_stem(name) + ".toml") : fs::path(arguments.file.out);
}

/// Of a URDF, or of an MJCF file with a URDF for it, to write beside the robot file.
struct RobotSource {
  RobotDescription description;
  std::vector<std::string> notes;
  bool is_converted = false;
};

RobotSource read_source(const NewRobotArguments& arguments, const PackageSearch& search) {
  constexpr std::size_t kLargest = 4u << 20;  // [bytes], as in RobotModel
  const fs::path path = fs::absolute(source_path(arguments.source, search)).lexically_normal();
  std::string text = read_text_file(path, kLargest).text;
  RobotSource source;
  if (!is_mjcf(text)) {
    source.description.urdf = path;
    source.description.urdf_text = std::move(text);
    return source;
  }
  const fs::path folder = fs::absolute(robot_file_path(arguments, "robot")).lexically_normal().parent_path();
  MjcfRobot mjcf = read_mjcf(path, folder);
  source.is_converted = true;
  source.description.urdf = folder / path.stem().concat(".urdf");  // where meshes are found from
  source.description.urdf_text = std::move(mjcf.urdf);
  source.description.armature = std::move(mjcf.armature);
  source.notes = std::move(mjcf.notes);
  return source;
}

int run_new_robot(const NewRobotArguments& arguments) {
  const PackageSearch search = package_search(arguments.package_dirs);
  if (!arguments.file.out.empty()) check_new_file(arguments.file.out, arguments.file.force);
  const RobotSource source = read_source(arguments, search);
  NewRobot robot = new_robot(source.description, search);
  const fs::path out = robot_file_path(arguments, robot.description.name);
  check_new_file(out, arguments.file.force);
  if (source.is_converted) robot.description.urdf = fs::absolute(out).lexically_normal().replace_extension(".urdf");
  const std::string text = robot_template(robot, urdf_reference(robot.description, out, search), out);
  if (source.is_converted) {
    check_new_file(robot.description.urdf, arguments.file.force);
    write_new_file(robot.description.urdf, robot.description.urdf_text);
  }
  // Read it like `prowl robot`: never write an unreadable file.
  const RobotModel model = load_robot({fs::absolute(out), text}, search);
  const RobotInspection inspection = inspect(model);
  write_new_file(out, text);
  if (arguments.json) {
    std::vector<fs::path> written = {out};
    if (source.is_converted) written.push_back(robot.description.urdf);
    print_json({.verb = "new", .written = written, .result = robot_report_json(model, inspection)});
    return kPassed;
  }
  std::string report =
      fmt::format("{}: {:.1f} kg, {} legs, {} contacts, {}\nwritten to {}\n", model.name(), model.mass(),
                  robot.search.legs.size(), model.contacts().size(),
                  robot.posture.found ? fmt::format("standing with the base at {:.3f} m", robot.posture.height)
                                      : "NO standing posture found",
                  out.string());
  for (const std::string& note : source.notes) report += fmt::format("note: {}\n", note);
  for (const RobotWarning& warning : inspection.warnings) report += fmt::format("warning: {}\n", warning.text);
  print_result(report +
               fmt::format("next: check the guesses in the file, then run prowl robot {0} and prowl new task {0}\n",
                           out.string()));
  return kPassed;
}

void add_new_robot(CLI::App& verb, int& status) {
  const auto arguments = std::make_shared<NewRobotArguments>();
  CLI::App* const robot = verb.add_subcommand(
      "robot", "Write a robot file for a URDF or MJCF file, with guesses of feet, posture and limits");
  robot
      ->add_option("source", arguments->source,
                   "URDF or MJCF file of a legged robot: a path, or package://NAME/PATH. For MJCF, a URDF is written "
                   "beside the robot file")
      ->required()
      ->type_name("URDF|MJCF");
  add_new_file(*robot, arguments->file, "robots/NAME.toml");
  add_json(*robot, arguments->json);
  add_package_dirs(*robot, arguments->package_dirs);
  set_footer(*robot,
             {"prowl new robot package://example-robot-data/robots/go2_description/urdf/go2.urdf --out go2.toml"},
             "0, 2 bad input and nothing is written, 4 files. Comments in the file mark all guesses.");
  robot->callback([arguments, &status] { status = run_new_robot(*arguments); });
}

struct NewTaskArguments {
  std::string robot;
  std::string kind = "crouch";
  std::vector<std::string> package_dirs;
  NewFileOptions file;
  bool json = false;
};

int run_new_task(const NewTaskArguments& arguments) {
  const fs::path robot_file = arguments.robot;
  const fs::path out = arguments.file.out.empty() ? fs::path("tasks") / robot_file.stem() / (arguments.kind + ".toml")
                                                  : fs::path(arguments.file.out);
  check_new_file(out, arguments.file.force);
  const PackageSearch search = package_search(arguments.package_dirs);
  const RobotModel robot = load_robot(read_text_file(robot_file), search);
  NewTask task;
  try {
    task = new_task(robot, arguments.kind);
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", robot_file.string(), error.what()));
  }
  const fs::path from = fs::absolute(out).lexically_normal().parent_path();
  const fs::path reference = fs::absolute(robot_file).lexically_normal().lexically_relative(from);
  const std::string text = task_template(task, robot, reference.generic_string());
  read_task_text({fs::absolute(out), text}, search);  // never write an unreadable file
  write_new_file(out, text);
  if (arguments.json) {
    const nlohmann::json result = {{"robot", robot.name()}, {"kind", arguments.kind}};
    print_json({.verb = "new", .written = {out}, .result = json_text(result)});
    return kPassed;
  }
  print_result(
      fmt::format("{0} {1}: written to {2}\nnext: prowl plan {2}\n", robot.name(), arguments.kind, out.string()));
  return kPassed;
}

void add_new_task(CLI::App& verb, int& status) {
  const auto arguments = std::make_shared<NewTaskArguments>();
  CLI::App* const task =
      verb.add_subcommand("task", "Write a task file for a robot, scaled to its size and ready to plan");
  task->add_option("robot", arguments->robot, "Robot file (docs/robot-file.md)")->required()->type_name("ROBOT.toml");
  task->add_option("--kind", arguments->kind,
                   "hold: stand still; stand: move the base a little; crouch: down and up (default); step: one step "
                   "forward; walk, trot, pace, bound, pronk: two strides of that gait on four legs")
      ->check(one_of(new_task_kinds()))
      ->type_name("NAME");
  add_new_file(*task, arguments->file, "tasks/ROBOT/KIND.toml");
  add_json(*task, arguments->json);
  add_package_dirs(*task, arguments->package_dirs);
  set_footer(*task, {"prowl new task robots/go2.toml --kind trot --out trot.toml && prowl plan trot.toml"},
             "0, 2 bad input and nothing is written, 4 files.");
  task->callback([arguments, &status] { status = run_new_task(*arguments); });
}

}  // namespace

void add_new_command(CLI::App& app, int& status) {
  CLI::App* const verb = app.add_subcommand("new", "Write a robot or task file to start from");
  verb->require_subcommand(1);
  set_footer(*verb,
             {"prowl new robot package://example-robot-data/robots/go2_description/urdf/go2.urdf --out go2.toml",
              "prowl new task robots/go2.toml --kind step --out step.toml"},
             "0, 2 bad input and nothing is written, 4 files. For help: prowl new robot --help");
  add_new_robot(*verb, status);
  add_new_task(*verb, status);
}

}  // namespace prowl::cli

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>

#include "cli/options/shared_options.hpp"
#include "cli/process/program_files.hpp"
#include "cli/process/python_script.hpp"
#include "cli/process/work_folder.hpp"
#include "cli/exit_status.hpp"
#include "cli/screen/json_result.hpp"
#include "cli/screen/output.hpp"
#include "cli/verbs/commands.hpp"
#include "cli/verbs/plan_tracker.hpp"
#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/files/csv_table.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/plan_folder/export_files.hpp"
#include "prowl/plan_folder/exports.hpp"
#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/simulation/mujoco_xml.hpp"

namespace prowl::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kLongestFile = std::size_t{4} << 30;  ///< [bytes]
const char* const kLibraries = "numpy, mcap and mcap-ros2-support";

struct ExportArguments {
  std::string directory, out, python = default_python();
  std::vector<std::string> formats, package_dirs;
  std::optional<double> rate;
  bool simulation = false, json = false;

  bool wants(const std::string& format) const { return std::ranges::find(formats, format) != formats.end(); }
};

std::vector<std::string> format_names() {
  std::vector<std::string> names;
  for (const ExportFormat& format : export_formats()) names.push_back(format.name);
  return names;
}

MotionSamples take_samples(const ExportArguments& arguments, const PlanRecord& plan) {
  const MotionProblem& problem = plan.task.problem;
  const fs::path directory = arguments.directory;
  std::error_code ignored;
  if (arguments.simulation) {
    for (const ExportFormat& format : export_formats()) {
      if (format.of_simulations || !arguments.wants(format.name)) continue;
      throw InputError(fmt::format("--format {} --simulation: of a simulation there is {} already", format.name,
                                   (directory / "simulate.csv").string()));
    }
    const fs::path file = directory / "simulate.csv";
    if (!fs::exists(file, ignored)) {
      throw InputError(fmt::format("{}: no such file; first prowl simulate {}", file.string(), arguments.directory));
    }
    return sample_simulation(problem, plan.plan.trajectory, read_csv_table(read_text_file(file, kLongestTable)),
                             arguments.rate);
  }
  std::optional<Tracker> tracker;
  if (fs::exists(directory / "tracker.bin", ignored)) tracker = read_tracker(directory, problem);
  return sample_plan(problem, plan.plan.trajectory, tracker ? &*tracker : nullptr, arguments.rate);
}

/// What the script of a format makes of the samples: "npz", "mcap".
std::string written_by_script(const ExportArguments& arguments, const WorkFolder& work, const std::string& format) {
  const fs::path result = work.path() / ("result." + format);  // NumPy adds the ending where it is missing
  run_script({arguments.python, kLibraries}, "exports/write_" + format + ".py",
             {(work.path() / "motion.json").string(), result.string()},
             [](const std::string& line) { print_message(line + "\n"); });
  return read_text_file(result, kLongestFile).text;
}

/// The files of all formats that were asked for, by name.
std::map<std::string, std::string> make_files(const ExportArguments& arguments, const PlanRecord& plan,
                                              const MotionSamples& samples) {
  const MotionProblem& problem = plan.task.problem;
  const std::string prefix = samples.simulated ? kSimulatedPrefix : "";
  std::map<std::string, std::string> files;
  if (arguments.wants("csv")) {
    files["motion.csv"] = motion_csv(problem, samples);
    if (!samples.gains.empty()) files["gains.csv"] = motion_gains_csv(problem.robot, samples);
  }
  if (arguments.wants("json")) files[prefix + "motion.json"] = motion_json(plan, samples);
  if (arguments.wants("joint-trajectory")) {
    files[prefix + "joint_trajectory.json"] = joint_trajectory_json(problem.robot, samples);
  }
  if (arguments.wants("mujoco")) {
    const std::string model_file = prefix + "mujoco_model.xml";
    files[model_file] = mujoco_xml(problem.robot, problem.surfaces, {.friction = plan.task.simulated_friction});
    files[prefix + "mujoco_keyframes.xml"] = mujoco_keyframes_xml(problem, samples, model_file);
  }
  if (arguments.wants("npz") || arguments.wants("mcap")) {
    const WorkFolder work;
    write_file_atomically(work.path() / "motion.json", exchange_json(plan, samples));
    if (arguments.wants("npz")) files[prefix + "motion.npz"] = written_by_script(arguments, work, "npz");
    if (arguments.wants("mcap")) files[prefix + "motion.mcap"] = written_by_script(arguments, work, "mcap");
  }
  return files;
}

void make_folder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error || !fs::is_directory(folder)) throw FileError(fmt::format("{}: cannot make this folder", folder.string()));
}

int run_export(const ExportArguments& arguments) {
  const fs::path out = arguments.out.empty() ? fs::path(arguments.directory) / kExportsFolder : fs::path(arguments.out);
  const PlanRecord plan = read_plan(arguments.directory, package_search(arguments.package_dirs));
  const MotionSamples samples = take_samples(arguments, plan);
  if (!is_good(plan.plan)) {
    print_message(fmt::format("warning: this plan is not good: {}, certificate {}\n",
                              to_string(plan.plan.result.status), plan.plan.certificate.passed ? "passed" : "failed"));
  }
  const std::map<std::string, std::string> files = make_files(arguments, plan, samples);
  make_folder(out);
  write_files_atomically(out, files);
  nlohmann::ordered_json json = {{"motion", samples.simulated ? "simulation" : "plan"},
                                 {"samples", samples.points.size()},
                                 {"has_gains", !samples.gains.empty()},
                                 {"files", nlohmann::ordered_json::array()}};
  std::string text;
  std::vector<fs::path> written;
  for (const auto& [name, content] : files) {
    written.push_back(out / name);
    text += fmt::format("{:>10.1f} kB  {}\n", 1e-3 * static_cast<double>(content.size()), (out / name).string());
    json["files"].push_back({{"name", name}, {"bytes", content.size()}});
  }
  text += fmt::format("{} samples of the {}, {:g} s, {}\n", samples.points.size(),
                      samples.simulated ? "simulation" : "plan", samples.points.back().time,
                      samples.gains.empty() ? "without gains" : "with gains");
  if (arguments.json) {
    print_json({.verb = "export",
                .plan = &plan,
                .directory = arguments.directory,
                .written = written,
                .result = json_text(json)});
  } else {
    print_result(text);
  }
  return kPassed;
}

}  // namespace

void add_export_command(CLI::App& app, int& status) {
  const auto arguments = std::make_shared<ExportArguments>();
  CLI::App* const verb = app.add_subcommand("export", "Write a plan or its simulation for other programs");
  add_plan_directory(*verb, arguments->directory);
  verb->add_option("--format", arguments->formats,
                   "One or more, with commas: " + CLI::detail::join(format_names(), ", "))
      ->required()
      ->delimiter(',')
      ->check(CLI::IsMember(format_names()))
      ->type_name("FORMAT");
  add_folder(*verb, "--out", arguments->out, "Folder for the files; default: DIR/exports");
  verb->add_option("--rate", arguments->rate,
                   "Samples a second; default: the nodes of the plan, all rows of the simulation")
      ->type_name("HZ");
  verb->add_flag("--simulation", arguments->simulation,
                 "The simulated motion of simulate.csv in place of the planned one");
  verb->add_option("--python", arguments->python,
                   fmt::format("Python with {}, for npz and mcap; default {}", kLibraries, arguments->python))
      ->type_name("PATH");
  add_json(*verb, arguments->json);
  add_package_dirs(*verb, arguments->package_dirs);
  set_footer(*verb,
             {"prowl export out/hyq_crouch --format csv,npz --rate 500",
              "prowl export out/hyq_crouch --format mcap --simulation"},
             "0 if they are written, 2 bad input, 4 files. What they hold, and who reads them: docs/exports.md.");
  verb->callback([arguments, &status] { status = run_export(*arguments); });
}

}  // namespace prowl::cli

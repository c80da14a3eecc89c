#include "prowl/plan_folder/plan_folder.hpp"

#include <fmt/format.h>

#include <set>

#include "prowl/error.hpp"
#include "prowl/files/atomic_folder.hpp"
#include "prowl/files/json_parse.hpp"
#include "prowl/files/json_text.hpp"
#include "prowl/plan_folder/export_files.hpp"
#include "prowl/plan_folder/figure_files.hpp"
#include "prowl/plan_folder/plan_json.hpp"
#include "prowl/plan_folder/tracker_file.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"

namespace prowl {
namespace {

const char* const kPlan = "plan.json";
const char* const kNodes = "trajectory.csv";
const char* const kUniform = "trajectory_uniform.csv";
const char* const kTracker = "tracker.bin";
/// All files that may be in the folder of a plan; a new plan replaces them.
const std::set<std::string>& own_names() {
  static const std::set<std::string> names = [] {
    std::set<std::string> all = {kPlan,           kNodes,         kUniform,     kTracker,
                                 "simulate.json", "simulate.csv", "sweep.json", kReportFile};
    for (const std::string& figure : figure_file_names()) all.insert(std::string(kFiguresFolder) + "/" + figure);
    for (const std::string& file : export_file_names()) all.insert(std::string(kExportsFolder) + "/" + file);
    return all;
  }();
  return names;
}

constexpr std::size_t kLongestPlan = 32u << 20;  // [bytes]; 4 MB of these may be the URDF

}  // namespace

void check_plan_directory(const std::filesystem::path& directory) { check_replaceable(directory, own_names()); }

void write_plan(const std::filesystem::path& directory, const PlanRecord& record, std::optional<double> uniform_step) {
  const MotionProblem& problem = record.task.problem;
  std::map<std::string, std::string> files;
  files[kPlan] = json_text(plan_to_json(record));
  files[kNodes] = trajectory_to_csv(problem, record.plan.trajectory);
  if (record.feedback) files[kTracker] = tracker_file_bytes(make_tracking_plan(problem, *record.feedback));
  if (uniform_step) {
    files[kUniform] = trajectory_to_csv(problem, sample_uniformly(record.plan.trajectory, *uniform_step));
  }
  write_folder_atomically(directory, files, own_names());
}

bool holds_good_plan(const std::filesystem::path& directory) {
  try {
    const nlohmann::ordered_json json = parse_json(read_text_file(directory / kPlan, kLongestPlan));
    return json.is_object() && json.contains("good") && json["good"] == true;
  } catch (const Error&) {
    return false;
  }
}

PlanRecord read_plan(const std::filesystem::path& directory, const PackageSearch& search, const OwnTerms& own_terms) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(directory, ignored)) {
    throw InputError(fmt::format("{}: this is a file; need the folder that prowl plan wrote", directory.string()));
  }
  PlanRecord record = plan_from_json(read_text_file(directory / kPlan, kLongestPlan), search, own_terms);
  const SourceText nodes =
      read_text_file(directory / kNodes, longest_trajectory(record.task.problem, record.plan.mesh));
  record.plan.trajectory.nodes = trajectory_from_csv(record.task.problem, record.plan.mesh, nodes).nodes;
  return record;
}

std::string plan_report_json(const PlanRecord& record, const std::filesystem::path& directory) {
  auto json = plan_to_json(record);
  json["task_file"].erase("text");
  json["robot_file"].erase("text");
  json["urdf"].erase("text");
  if (record.task.reference_file) json["reference_file"].erase("text");
  if (!directory.empty()) json["directory"] = std::filesystem::absolute(directory).lexically_normal().string();
  return json_text(json);
}

}  // namespace prowl

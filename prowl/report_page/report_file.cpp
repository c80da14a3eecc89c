#include "prowl/report_page/report_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "prowl/error.hpp"
#include "prowl/files/json_parse.hpp"
#include "prowl/plan_folder/motion_points.hpp"
#include "prowl/plan_folder/plan_json.hpp"
#include "prowl/report_page/report_json.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "prowl/trajectory/phase_span.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kGainStep = 0.02;  ///< [s]

/// Phases with their planned times and contacts.
Json phases_json(const MotionProblem& problem, const Plan& plan) {
  Json phases = Json::array();
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const std::optional<PhaseSpan> span = phase_span(plan.trajectory, p);
    if (!span) continue;
    Json contacts = Json::array();
    for (const PhaseContact& held : problem.phases[p].contacts) {
      contacts.push_back({{"contact", held.contact}, {"surface", held.surface}});
    }
    phases.push_back({{"name", problem.phases[p].name},
                      {"start", span->start},
                      {"end", span->end},
                      {"intervals", plan.mesh.phases[p].intervals()},
                      {"contacts", contacts}});
  }
  return phases;
}

/// Quotes a shell argument if necessary.
std::string shell_quoted(const std::string& text) {
  const auto is_plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || std::string_view("/._-+:=,@%").find(static_cast<char>(c)) != std::string_view::npos;
  };
  if (!text.empty() && std::all_of(text.begin(), text.end(), is_plain)) return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return quoted + "'";
}

/// Command that reproduces the plan.
std::string plan_command(const PlanRecord& record) {
  const TaskOverrides& overrides = record.task.overrides;
  std::string command = "prowl plan " + shell_quoted(record.task.task_file.path.string());
  std::string solver = record.plan.solver;
  std::transform(solver.begin(), solver.end(), solver.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  const std::vector<std::string>& names = solver_names();
  if (solver != names.front() && std::find(names.begin(), names.end(), solver) != names.end())
    command += " --solver " + solver;
  if (overrides.intervals) command += fmt::format(" --intervals {}", *overrides.intervals);
  if (overrides.max_iterations) command += fmt::format(" --max-iterations {}", *overrides.max_iterations);
  if (overrides.max_seconds) command += fmt::format(" --max-time {}", *overrides.max_seconds);
  if (overrides.tolerance) command += fmt::format(" --tolerance {}", *overrides.tolerance);
  if (overrides.robust) command += " --robust";
  if (!record.warm_start.empty()) command += " --warm-start " + shell_quoted(record.warm_start);
  return command;
}

Json parse_simulation(const ReportInputs& inputs) {
  if (!inputs.simulation_json) return nullptr;
  Json json = parse_json(*inputs.simulation_json);
  if (!json.is_object())
    throw InputError(inputs.simulation_json->path.string() + ": not JSON; run prowl simulate again");
  return json;
}

/// Of a robust plan; none without gains.
std::optional<Tube> tube_of(const PlanRecord& record) {
  if (!record.robustness) return std::nullopt;
  try {
    return make_tube(record.task.problem, record.plan.trajectory, record.task.tracking, record.robustness->sizes);
  } catch (const NumericalError&) {
    return std::nullopt;
  }
}

/// Data of one plan and its simulation.
Json report_data(const ReportInputs& inputs, const PackageSearch& search, std::vector<std::string>& warnings) {
  const PlanRecord& record = inputs.plan;
  const MotionProblem& problem = record.task.problem;
  const RobotModel& robot = problem.robot;

  const Trajectory& trajectory = record.plan.trajectory;
  const double step = report_step(trajectory.duration());
  const std::vector<TrajectoryPoint> plan = report_points(trajectory, step);
  std::vector<TrajectoryPoint> simulation;
  if (inputs.simulation) simulation = simulated_points(robot, read_csv_table(*inputs.simulation), step);
  const std::optional<Tube> tube = tube_of(record);

  Json data = {{"format", 1},
               {"directory", inputs.directory},
               {"robot", robot.name()},
               {"weight_N", robot.weight()},
               {"size_m", robot.size()},
               {"joints", robot.joint_names()},
               {"phases", phases_json(problem, inputs.plan.plan)},
               {"plan_json", plan_to_json(record)},
               {"command", plan_command(record)},
               {"simulated_friction", nullptr},
               {"scene", report_scene(robot, problem.surfaces, search, warnings)},
               {"plan", report_motion_json(robot, plan)},
               {"simulation", nullptr},
               {"simulation_json", parse_simulation(inputs)},
               {"charts", report_charts(problem, plan, simulation, tube ? &*tube : nullptr)},
               {"gains", nullptr},
               {"live", nullptr}};
  if (record.task.simulated_friction) data["simulated_friction"] = *record.task.simulated_friction;
  if (!simulation.empty()) data["simulation"] = report_motion_json(robot, simulation);
  if (inputs.tracking) data["gains"] = report_gains(*inputs.tracking, kGainStep);
  return data;
}

/// Data of a second plan, to compare with `first`; its scene is null if both are equal.
Json other_data(const ReportInputs& inputs, const Json& first, const PackageSearch& search,
                std::vector<std::string>& warnings) {
  std::vector<std::string> own_warnings;
  Json data = report_data(inputs, search, own_warnings);
  for (const std::string& warning : own_warnings) {
    if (std::find(warnings.begin(), warnings.end(), warning) == warnings.end()) warnings.push_back(warning);
  }
  Json other;
  for (const char* key :
       {"directory", "robot", "size_m", "phases", "plan_json", "plan", "simulation", "simulation_json", "charts"}) {
    other[key] = std::move(data[key]);
  }
  other["scene"] = data["scene"] == first["scene"] ? Json(nullptr) : std::move(data["scene"]);
  return other;
}

}  // namespace

Report make_report(const ReportInputs& inputs, const PackageSearch& search, const ReportInputs* other) {
  Report report;
  Json data = report_data(inputs, search, report.warnings);
  data["other"] = nullptr;
  if (other != nullptr) data["other"] = other_data(*other, data, search, report.warnings);
  data["warnings"] = report.warnings;
  if (inputs.state != PageState::file) data["live"] = {{"solved", inputs.state == PageState::solved}};
  report.html = filled_page(inputs.template_html, data.dump(-1, ' ', false, Json::error_handler_t::replace),
                            inputs.state != PageState::file);
  return report;
}

std::string report_iterate(const MotionProblem& problem, const Plan& iterate, const MeshIteration& at) {
  const Trajectory& motion = iterate.trajectory;
  const std::vector<TrajectoryPoint> points = report_points(motion, report_step(motion.duration()));
  const Json json = {{"level", at.level},
                     {"intervals", iterate.mesh.num_intervals()},
                     {"iteration", at.progress.iteration},
                     {"cost", at.progress.cost},
                     {"constraint_violation", at.progress.constraint_violation},
                     {"dual_violation", at.progress.dual_violation},
                     {"seconds", at.progress.elapsed_seconds},
                     {"phases", phases_json(problem, iterate)},
                     {"plan", report_motion_json(problem.robot, points)},
                     {"charts", report_charts(problem, points, {})}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace prowl

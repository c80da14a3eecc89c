#include "prowl/plan_folder/simulation_parts.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prowl/files/atomic_folder.hpp"
#include "prowl/simulation/perturbations.hpp"

namespace prowl {

using Json = nlohmann::ordered_json;

Json verdict_json(const PlanRecord& plan, const SimulationVerdict& verdict) {
  const SuccessCriteria& criteria = plan.task.success;
  return {{"schema_version", 1},
          {"engine", verdict.engine},
          {"name", plan.task.problem.name},
          {"robot", plan.task.problem.robot.name()},
          {"success", verdict.failures.empty()},
          {"failures", verdict.failures},
          {"end", verdict.end},
          {"end_time_s", verdict.end_time},
          {"phase", verdict.phase},
          {"criteria",
           {{"base_position_m", criteria.position}, {"base_angle_rad", criteria.angle}, {"rest_s", criteria.rest}}}};
}

Json error_json(const ErrorMeasure& error) {
  return {{"largest", error.largest}, {"rms", error.rms}, {"rest", error.rest}};
}

Json vector_json(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

std::string world_in_words(const RobotModel& robot, const SimulationOptions& options) {
  const std::string motors = options.bandwidth > 0.0 ? fmt::format("{:.0f} Hz", options.bandwidth) : "ideal motors";
  std::string text = fmt::format("mass x {:.2f}, friction x {:.2f}, {}, {:.1f} ms, tilt {:.1f} deg",
                                 mass_factor(robot, options.physics), options.physics.friction_scale, motors,
                                 1e3 * (options.delay + options.unknown_delay), options.ground.tilt.norm() / kDegree);
  for (const Push& push : options.pushes) {
    text += fmt::format(", {:.3g} N s towards {:.0f} deg at {:.2f} s", push.impulse.norm(),
                        std::atan2(push.impulse.y(), push.impulse.x()) / kDegree, push.time);
  }
  return text;
}

Json torque_json(const TorqueUse& use) {
  return {{"largest_share", use.largest_share},
          {"joint", use.joint},
          {"saturated_share_of_time", use.saturated},
          {"positive_work_J", use.positive_work}};
}

std::string torque_line(const TorqueUse& use) {
  const std::string largest = std::isfinite(use.largest_share) ? fmt::format("{:.0f} % of the limit at most ({})",
                                                                             100 * use.largest_share, use.joint)
                                                               : fmt::format("{} exceeded a limit of zero", use.joint);
  return fmt::format("  torque      {}, at a limit {:.1f} % of the time, {:.0f} J of work\n", largest,
                     100 * use.saturated, use.positive_work);
}

std::string error_heading() {
  return fmt::format("  {:<28}{:>12}{:>12}{:>12}\n", "error", "largest", "RMS", "at rest");
}

std::string error_line(const std::string& name, const ErrorMeasure& error, double unit, const std::string& unit_name) {
  const auto value = [&](double size) -> std::string {
    return std::isnan(size) ? "-" : fmt::format("{:.2f} {}", size / unit, unit_name);  // it ended before it was at rest
  };
  return fmt::format("  {:<28}{:>12}{:>12}{:>12}\n", name, value(error.largest), value(error.rms), value(error.rest));
}

void write_simulation_files(const std::filesystem::path& directory, const std::string& json, const std::string& csv) {
  write_files_atomically(directory, {{"simulate.csv", csv}, {"simulate.json", json}});
}

}  // namespace prowl

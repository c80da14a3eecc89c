#pragma once

#include <numbers>
#include <string>
#include <vector>

#include "prowl/files/json_text.hpp"
#include "prowl/plan_folder/simulation_files.hpp"

// Common parts of the results of both engines of `prowl simulate`.
namespace prowl {

inline constexpr double kDegree = std::numbers::pi / 180.0;

/// The first keys of simulate.json.
struct SimulationVerdict {
  std::string engine;  ///< as for --engine
  std::vector<std::string> failures;
  std::string end;
  double end_time = 0.0;  ///< [s]
  std::string phase;
};
nlohmann::ordered_json verdict_json(const PlanRecord& plan, const SimulationVerdict& verdict);
nlohmann::ordered_json error_json(const ErrorMeasure& error);
nlohmann::ordered_json vector_json(const Eigen::VectorXd& values);

/// Load of the joints: largest share of a torque limit and its joint, share of the time at a limit, work [J].
struct TorqueUse {
  double largest_share = 0.0;
  std::string joint;
  double saturated = 0.0, positive_work = 0.0;
};
nlohmann::ordered_json torque_json(const TorqueUse& use);
std::string torque_line(const TorqueUse& use);

/// The case of a sweep: "mass x 1.02, friction x 0.81, ...".
std::string world_in_words(const RobotModel& robot, const SimulationOptions& options);

/// A table of errors: its heading, and a line in units of `unit`.
std::string error_heading();
std::string error_line(const std::string& name, const ErrorMeasure& error, double unit, const std::string& unit_name);

/// simulate.json and simulate.csv, each whole or not at all. Throws FileError.
void write_simulation_files(const std::filesystem::path& directory, const std::string& json, const std::string& csv);

}  // namespace prowl

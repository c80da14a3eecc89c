#pragma once

#include <filesystem>
#include <string>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/simulation/simulation.hpp"

namespace prowl {

/// Options and result of `prowl simulate` with MuJoCo.
struct SimulationRecord {
  SimulationOptions options;
  SimulationResult result;
};

/// Summary for the screen.
std::string simulation_summary(const PlanRecord& plan, const SimulationRecord& record);
/// simulate.json (docs/simulation.md).
std::string simulation_json(const PlanRecord& plan, const SimulationRecord& record);
/// simulate.csv: one row per sample.
std::string simulation_csv(const RobotModel& robot, const std::vector<SimulationSample>& samples);

/// Writes simulate.json and simulate.csv into the plan's folder, each whole or not at all. Throws FileError.
void write_simulation(const std::filesystem::path& directory, const PlanRecord& plan, const SimulationRecord& record);

}  // namespace prowl

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracking/rollout_measures.hpp"

namespace prowl {

/// Options and result of `prowl simulate --engine rollout`.
struct RolloutRecord {
  RolloutOptions options;
  Eigen::Vector3d base_offset = Eigen::Vector3d::Zero();  ///< at the start, world frame [m]
  Eigen::Vector3d base_offset_rpy =
      Eigen::Vector3d::Zero();          ///< at the start: roll, pitch, yaw in the base frame [rad]
  std::optional<double> friction = {};  ///< to check contact forces with, in place of the surfaces'
  double record_rate = 0.0;             ///< of simulate.csv [Hz]; 0: no rows
  Rollout rollout;
  RolloutMeasures measures;
  std::vector<std::string> failures;  ///< unmet criteria in words; empty: success
};

/// The task's criteria that a rollout does not meet: it must not fall, and its base must be at rest where the plan
/// ends. A rollout has no slip.
std::vector<std::string> rollout_failures(const Tracker& tracker, const Rollout& rollout,
                                          const RolloutMeasures& measures, const SuccessCriteria& criteria);

/// Summary for the screen.
std::string rollout_summary(const PlanRecord& plan, const RolloutRecord& record);
/// simulate.json (docs/simulation.md).
std::string rollout_json(const PlanRecord& plan, const Tracker& tracker, const RolloutRecord& record);
/// simulate.csv, in the columns of simulation_csv(): the controller sees the true state, and contacts touch as
/// scheduled.
std::string rollout_csv(const RobotModel& robot, const Tracker& tracker, const RolloutRecord& record);

/// Writes simulate.json and simulate.csv into the plan's folder, each whole or not at all. Throws FileError.
void write_rollout(const std::filesystem::path& directory, const PlanRecord& plan, const Tracker& tracker,
                   const RolloutRecord& record);

}  // namespace prowl

#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "prowl/plan_folder/plan_folder.hpp"
#include "prowl/simulation/simulation_options.hpp"
#include "prowl/tracking/rollout_measures.hpp"

namespace prowl {

/// What `prowl simulate --engine rollout` was asked for, and what came out.
struct RolloutRecord {
  RolloutOptions options;
  Eigen::Vector3d base_offset = Eigen::Vector3d::Zero();  ///< at the start, world frame [m]
  Eigen::Vector3d base_offset_rpy =
      Eigen::Vector3d::Zero();          ///< at the start: roll, pitch, yaw in the base frame [rad]
  std::optional<double> friction = {};  ///< that contact forces are held against, in place of the surfaces'
  double record_rate = 0.0;             ///< of simulate.csv [Hz]; 0: no rows
  Rollout rollout;
  RolloutMeasures measures;
  std::vector<std::string> failures;  ///< of the criteria that apply, in words; empty: success
};

/// Which of the task's criteria a rollout does not meet: it must not fall, and its base has to rest where the plan
/// ends. Slip there is none.
std::vector<std::string> rollout_failures(const Tracker& tracker, const Rollout& rollout,
                                          const RolloutMeasures& measures, const SuccessCriteria& criteria);

/// What fits a screen.
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

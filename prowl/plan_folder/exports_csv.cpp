#include <fmt/format.h>
#include <fmt/ranges.h>

#include <iterator>

#include "prowl/plan_folder/exports.hpp"
#include "prowl/plan_folder/gain_columns.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"

namespace prowl {

std::string motion_csv(const MotionProblem& problem, const MotionSamples& samples) {
  return trajectory_to_csv(problem, Trajectory{samples.points});
}

std::string motion_gains_csv(const RobotModel& robot, const MotionSamples& samples) {
  if (samples.gains.empty()) return "";
  std::string text = "time_s,phase";
  for (const std::string& joint : robot.joint_names()) {
    for (const std::string& column : gain_columns(robot)) text += fmt::format(",{}:{}", joint, column);
  }
  text += '\n';
  for (std::size_t i = 0; i < samples.points.size(); ++i) {
    const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> K = samples.gains[i];
    fmt::format_to(std::back_inserter(text), "{},{},{}\n", samples.points[i].time, samples.points[i].phase,
                   fmt::join(K.data(), K.data() + K.size(), ","));
  }
  return text;
}

}  // namespace prowl

#include "prowl/plan_folder/motion_points.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"

namespace prowl {
namespace {

constexpr double kStep = 0.01;  ///< [s]: one per picture at 60 Hz and a fifth of the speed
constexpr double kMostPoints = 3000;

/// First columns of the blocks of the file; the columns of a block are contiguous, in the order of the robot's names.
struct Blocks {
  Eigen::Index time, base, joints, twist, rates, torques;
  std::vector<Eigen::Index> forces;
};

Blocks find_blocks(const RobotModel& robot, const CsvTable& table) {
  const std::string& joint = robot.joint_names().front();
  Blocks blocks{table.index("time_s"),
                table.index("true_base_px_m"),
                table.index(fmt::format("true_q_{}_rad", joint)),
                table.index("true_base_vx_mps"),
                table.index(fmt::format("true_v_{}_radps", joint)),
                table.index(fmt::format("tau_{}_Nm", joint)),
                {}};
  for (const std::string& name : robot.joint_names()) {  // checks that the file is of this robot
    const Eigen::Index j = &name - robot.joint_names().data();
    if (table.index(fmt::format("true_q_{}_rad", name)) != blocks.joints + j ||
        table.index(fmt::format("true_v_{}_radps", name)) != blocks.rates + j ||
        table.index(fmt::format("tau_{}_Nm", name)) != blocks.torques + j) {
      throw InputError(fmt::format("{}:1: the columns are not those of {}", table.file, robot.name()));
    }
  }
  for (const ContactPoint& contact : robot.contacts()) {
    blocks.forces.push_back(table.index(fmt::format("f_{}_x_N", contact.name)));
  }
  return blocks;
}

}  // namespace

double report_step(double duration) { return std::max(kStep, duration / kMostPoints); }

std::vector<TrajectoryPoint> report_points(const Trajectory& trajectory, double step) {
  std::vector<TrajectoryPoint> points;
  for (std::size_t k = 0; k < trajectory.nodes.size(); ++k) {
    const TrajectoryPoint& node = trajectory.nodes[k];
    points.push_back(node);
    if (k + 1 == trajectory.nodes.size() || trajectory.nodes[k + 1].phase != node.phase) continue;
    const TrajectoryPoint& next = trajectory.nodes[k + 1];
    const double length = next.time - node.time;
    const int parts = std::max(1, static_cast<int>(std::ceil(length / step - 1e-9)));
    for (int i = 1; i < parts; ++i) points.push_back(sample(trajectory, node.time + length * i / parts));
  }
  return points;
}

std::vector<TrajectoryPoint> simulated_points(const RobotModel& robot, const CsvTable& simulation, double step) {
  const Blocks at = find_blocks(robot, simulation);
  const Eigen::Index nu = robot.nu();
  std::vector<TrajectoryPoint> points;
  for (Eigen::Index r = 0; r < simulation.rows(); ++r) {
    const auto row = simulation.values.col(r);
    if (!row.allFinite()) break;  // MuJoCo diverged
    if (!points.empty() && row(at.time) < points.back().time + step * (1.0 - 1e-6) && r + 1 < simulation.rows())
      continue;
    TrajectoryPoint& point = points.emplace_back();
    point.time = row(at.time);
    point.q.resize(robot.nq());
    point.q << row.segment(at.base, 7), row.segment(at.joints, nu);
    point.q.segment<4>(3).normalize();  // the file has nine digits
    point.v.resize(robot.nv());
    point.v << row.segment(at.twist, 6), row.segment(at.rates, nu);
    point.tau = row.segment(at.torques, nu);
    point.force.resize(3 * static_cast<Eigen::Index>(at.forces.size()));
    for (std::size_t c = 0; c < at.forces.size(); ++c) {
      point.force.segment<3>(3 * static_cast<Eigen::Index>(c)) = row.segment<3>(at.forces[c]);
    }
  }
  return points;
}

}  // namespace prowl

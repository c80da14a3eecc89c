#include "prowl/plan_folder/figure_data.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/error.hpp"
#include "prowl/plan_folder/gain_columns.hpp"
#include "prowl/text/nearest_name.hpp"

namespace prowl {
namespace {

constexpr int kCurvePoints = 200;
const char* const kAxes[] = {"x", "y", "z"};

/// A CSV text, row by row; numbers with all digits.
class Table {
 public:
  explicit Table(const std::vector<std::string>& columns) : text_(fmt::format("{}\n", fmt::join(columns, ","))) {}
  void add(const std::vector<double>& row) { fmt::format_to(std::back_inserter(text_), "{}\n", fmt::join(row, ",")); }
  std::string take() { return std::move(text_); }

 private:
  std::string text_;
};

/// Appends the rows of one instant: of each contact in turn, J a and −J̇v.
class ContactAcceleration {
 public:
  explicit ContactAcceleration(const MotionProblem& problem) : problem_(problem), terms_(problem.robot) {
    for (const Phase& phase : problem.phases) kinematics_.emplace_back(contact_indices(phase.contacts));
  }

  std::vector<double> operator()(const TrajectoryPoint& point) {
    ContactKinematics& kinematics = kinematics_[point.phase];
    terms_.update_kinematics(point.q);
    kinematics.set_configuration(terms_);
    const Eigen::VectorXd from_a = kinematics.jacobian() * point.a;
    kinematics.set_motion(point.v, Eigen::VectorXd::Zero(point.v.size()));  // leaves J̇v alone

    std::vector<double> row(2 + 6 * problem_.robot.contacts().size(), std::numeric_limits<double>::quiet_NaN());
    row[0] = point.time;
    row[1] = point.phase;
    for (std::size_t i = 0; i < kinematics.contacts().size(); ++i) {
      double* const cells = row.data() + 2 + 6 * kinematics.contacts()[i];
      for (int axis = 0; axis < 3; ++axis) {
        const auto k = static_cast<Eigen::Index>(3 * i) + axis;
        cells[axis] = from_a(k);
        cells[3 + axis] = -kinematics.acceleration()(k);
      }
    }
    return row;
  }

 private:
  const MotionProblem& problem_;
  RigidBodyTerms terms_;
  std::vector<ContactKinematics> kinematics_;  ///< one a phase
};

}  // namespace

std::string contact_acceleration_csv(const MotionProblem& problem, const Trajectory& trajectory, double step) {
  std::vector<std::string> columns = {"time_s", "phase"};
  for (const ContactPoint& contact : problem.robot.contacts()) {
    for (const char* term : {"Ja", "minus_Jdotv"}) {
      for (const char* axis : kAxes) columns.push_back(fmt::format("{}_{}_{}_mps2", term, contact.name, axis));
    }
  }
  Table table(columns);
  ContactAcceleration row(problem);
  for (std::size_t k = 0; k < trajectory.nodes.size(); ++k) {
    const TrajectoryPoint& node = trajectory.nodes[k];
    table.add(row(node));
    if (k + 1 == trajectory.nodes.size() || trajectory.nodes[k + 1].phase != node.phase) continue;
    const TrajectoryPoint& next = trajectory.nodes[k + 1];
    const double length = next.time - node.time;
    const int parts = std::max(1, static_cast<int>(std::ceil(length / step - 1e-9)));
    for (int i = 1; i < parts; ++i) table.add(row(interpolate(node, next, length * i / parts)));
  }
  return table.take();
}

std::string gains_csv(const RobotModel& robot, const Tracker& tracker, int joint) {
  const TrackingPlan& plan = tracker.plan();
  if (plan.joint_names != robot.joint_names()) throw InputError("the gains are not those of " + robot.name());
  std::vector<std::string> columns = {"time_s", "segment"};
  for (const std::string& column : gain_columns(robot)) columns.push_back(column);
  Table table(columns);
  for (std::size_t s = 0; s < plan.segments.size(); ++s) {
    const TrackingPlan::Segment& segment = plan.segments[s];
    for (int i = 0; i < segment.samples; ++i) {
      const double share = static_cast<double>(i) / (segment.samples - 1);
      const Eigen::Map<const Eigen::MatrixXd> K(plan.gains.col(segment.first_sample + i).data(), plan.nu(),
                                                2 * plan.nv());
      std::vector<double> row = {segment.start + share * (segment.end - segment.start), static_cast<double>(s)};
      const Eigen::RowVectorXd gains = K.row(joint);
      row.insert(row.end(), gains.begin(), gains.end());
      table.add(row);
    }
  }
  return table.take();
}

std::string torque_limits_csv(const RobotModel& robot, const Trajectory& trajectory) {
  std::vector<std::string> columns = {"time_s"};
  for (const std::string& name : robot.joint_names()) {
    columns.push_back(fmt::format("lower_{}_Nm", name));
    columns.push_back(fmt::format("upper_{}_Nm", name));
  }
  Table table(columns);
  for (const TrajectoryPoint& node : trajectory.nodes) {
    std::vector<double> row = {node.time};
    for (int j = 0; j < robot.nu(); ++j) {
      row.push_back(robot.torque_lower(j, node.q(7 + j), node.v(6 + j)));
      row.push_back(robot.torque_upper(j, node.q(7 + j), node.v(6 + j)));
    }
    table.add(row);
  }
  return table.take();
}

std::string limit_curves_csv(const RobotModel& robot) {
  std::string text = "joint,position_rad,limit_Nm\n";
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    if (limit.over_velocity) continue;
    const double first = limit.curve.lower_end(), last = limit.curve.upper_end();
    for (int i = 0; i < kCurvePoints; ++i) {
      const double position = first + (last - first) * i / (kCurvePoints - 1);
      fmt::format_to(std::back_inserter(text), "{},{},{}\n", robot.joint_names()[limit.joint], position,
                     robot.torque_upper(limit.joint, position, 0.0));
    }
  }
  return text;
}

std::string legs_csv(const RobotModel& robot) {
  const RigidBodyTerms terms(robot);
  std::vector<int> leg_of(static_cast<std::size_t>(robot.nu()), -1);
  int legs = 0;
  for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) {
    const std::vector<int>& chain = terms.contact_chain(c);
    const auto first = std::find_if(chain.begin(), chain.end(), [](int dof) { return dof >= 6; });
    if (first == chain.end()) continue;  // on the base itself
    int& leg = leg_of[*first - 6];
    if (leg < 0) leg = legs++;
    for (auto dof = first; dof != chain.end(); ++dof) leg_of[*dof - 6] = leg;
  }
  std::replace(leg_of.begin(), leg_of.end(), -1, legs);  // arms, head
  std::string text = "joint,leg\n";
  for (std::size_t j = 0; j < leg_of.size(); ++j) {
    fmt::format_to(std::back_inserter(text), "{},{}\n", robot.joint_names()[j], leg_of[j]);
  }
  return text;
}

int joint_index(const RobotModel& robot, const std::string& name) {
  const std::vector<std::string>& names = robot.joint_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw InputError(fmt::format("--joint: {} has no joint '{}'{}", robot.name(), name, did_you_mean(name, names)));
  }
  return static_cast<int>(found - names.begin());
}

int default_gains_joint(const RobotModel& robot) {
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    if (!limit.over_velocity) return limit.joint;
  }
  const RigidBodyTerms terms(robot);
  return robot.contacts().empty() ? 0 : std::max(0, terms.contact_chain(0).back() - 6);
}

}  // namespace prowl

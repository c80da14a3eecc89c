#include "prowl/task_file/task_start.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/inverse_kinematics.hpp"
#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {
namespace {

constexpr double kLargestGap = 1e-2;     // [m] that joints may correct
constexpr double kLeastGap = 1e-3;       // [m]; validate() accepts smaller ones
constexpr double kLargestSlip = 5e-2;    // [m/s] that joint rates may correct
constexpr double kNoSlip = 1e-6;         // [m/s] left by the correction: validate() accepts more
constexpr double kRankThreshold = 1e-6;  // of the Jacobian of the legs, relative

/// Throws InputError with the joint and the location of its position if the posture violates a
/// joint limit.
void check_start(const RobotModel& robot, const Eigen::VectorXd& q, const std::optional<TomlValue>& joints,
                 const SourceText& robot_file) {
  for (int j = 0; j < robot.nu(); ++j) {
    const double position = q(7 + j);
    if (position >= robot.position_lower()(j) && position <= robot.position_upper()(j)) continue;
    const std::string& name = robot.joint_names()[j];
    const std::string message = fmt::format("the start posture has {:g} rad, outside the joint's limits [{:g}, {:g}]",
                                            position, robot.position_lower()(j), robot.position_upper()(j));
    if (joints) {
      for (const auto& [key, value] : joints->as_named_values(robot.joint_names(), "joint")) {
        if (key == name) value.fail(message);
      }
    }
    const std::string path = "nominal.joints." + name;
    throw InputError(fmt::format("{}{}: {}", locate(robot_file, path), path, message));
  }
}

std::size_t find_name(const TomlValue& value, const std::string& what, const std::vector<std::string>& names) {
  const auto found = std::find(names.begin(), names.end(), value.as_text());
  if (found == names.end()) value.fail_unknown_name(what, names);
  return static_cast<std::size_t>(found - names.begin());
}

/// Moves a posture from level ground, z = 0, to a surface: by the shortest rotation, the origin to
/// its point.
void put_on(const Surface& surface, TaskStart& start) {
  const Eigen::Matrix3d turn = so3::shortest_rotation(Eigen::Vector3d::UnitZ(), surface.normal);
  const Eigen::Matrix3d R = turn * base_rotation(start.q);
  start.q.head<3>() = (surface.point + turn * start.q.head<3>()).eval();
  set_base_rotation(start.q, R);
  start.rpy = rpy_from_rotation(R);
}

void read_velocity(const TomlTable& table, const RobotModel& robot, Eigen::VectorXd& v) {
  if (const auto linear = table.find("base_linear_velocity_mps")) v.head<3>() = linear->as_vector3();
  if (const auto angular = table.find("base_angular_velocity_radps")) v.segment<3>(3) = angular->as_vector3();
  const auto rates = table.find("joint_velocity_radps");
  if (!rates) return;
  const std::vector<std::string>& names = robot.joint_names();
  for (const auto& [name, value] : rates->as_named_values(names, "joint")) {
    v(6 + (std::ranges::find(names, name) - names.begin())) = value.as_number();
  }
}

/// The contacts of a phase: what moves them, and how fast.
struct Footing {
  Footing(const RobotModel& robot, const Phase& phase, const TaskStart& start)
      : kinematics(contact_indices(phase.contacts)) {
    RigidBodyTerms terms(robot);
    terms.update_kinematics(start.q);
    kinematics.set_configuration(terms);
    slip = kinematics.jacobian() * start.v;
  }
  double largest_slip() const {
    double largest = 0.0;
    for (Eigen::Index row = 0; row < slip.size(); row += 3) largest = std::max(largest, slip.segment<3>(row).norm());
    return largest;
  }

  ContactKinematics kinematics;
  Eigen::VectorXd slip;  ///< velocities, 3 per contact [m/s]
};

void put_contacts_down(const RobotModel& robot, const std::vector<Surface>& surfaces, const Phase& first,
                       TaskStart& start) {
  const Footing footing(robot, first, start);
  std::vector<ContactTarget> targets;
  double largest = 0.0;
  for (std::size_t i = 0; i < first.contacts.size(); ++i) {
    const auto& [contact, surface, foothold] = first.contacts[i];
    const Eigen::Vector3d position = footing.kinematics.positions().segment<3>(static_cast<Eigen::Index>(3 * i));
    const Surface& below = surfaces[static_cast<std::size_t>(surface)];
    const double gap = below.distance(position) - robot.contacts()[static_cast<std::size_t>(contact)].radius;
    targets.push_back({contact, position - gap * below.normal});
    largest = std::max(largest, std::abs(gap));
  }
  if (!(largest > kLeastGap && largest <= kLargestGap)) return;
  const InverseKinematics standing = inverse_kinematics(robot, start.q, targets);
  if (standing.converged) start.q = standing.q;
}

void stop_contacts(const TomlTable& root, const RobotModel& robot, const Phase& first, TaskStart& start) {
  if (start.v.isZero(0.0)) return;
  const Footing footing(robot, first, start);
  const auto table = root.find_table("start");
  if (!table || footing.largest_slip() == 0.0) return;
  const auto rates = table->find("joint_velocity_radps");
  if (rates && footing.largest_slip() > kLargestSlip) {
    rates->fail(
        fmt::format("the contacts of the first phase move at up to {:.3g} m/s; need at most {} m/s, which the "
                    "joints correct, or no joint rates: these then follow from the base",
                    footing.largest_slip(), kLargestSlip));
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> legs;
  legs.setThreshold(kRankThreshold);
  legs.compute(footing.kinematics.jacobian().rightCols(robot.nu()));
  start.v.tail(robot.nu()) -= legs.solve(footing.slip);
  const double left = Footing(robot, first, start).largest_slip();
  if (left > kNoSlip) {
    table->value().fail(
        fmt::format("no joint rates keep the contacts of the first phase still at this velocity of the "
                    "base: they move at {:.3g} m/s",
                    left));
  }
  for (int j = 0; j < robot.nu(); ++j) {
    const double rate = start.v(6 + j), limit = robot.velocity_limit()(j);
    if (std::abs(rate) <= limit) continue;
    table->value().fail(fmt::format("{} turns at {:.3g} rad/s, beyond its limit of {:.3g} rad/s",
                                    robot.joint_names()[static_cast<std::size_t>(j)], rate, limit));
  }
}

}  // namespace

TaskStart read_start(const TomlTable& root, const RobotModel& robot, const SourceText& robot_file,
                     const std::vector<Surface>& surfaces) {
  TaskStart start{robot.nominal_configuration(), Eigen::VectorXd::Zero(robot.nv()),
                  robot.description().nominal_base_rpy};
  std::optional<TomlValue> joints;
  if (const auto table = root.find_table("start")) {
    RobotDescription posture = robot.description();
    joints = table->find("joints");
    if (joints) {
      for (const auto& [name, value] : joints->as_named_values(robot.joint_names(), "joint")) {
        posture.nominal_joints[name] = value.as_number();
      }
    }
    if (const auto rpy = table->find("base_rpy_rad")) posture.nominal_base_rpy = rpy->as_vector3();
    // RobotModel puts its nominal posture on the ground.
    start.q = RobotModel(posture).nominal_configuration();
    start.rpy = posture.nominal_base_rpy;
    const auto position = table->find("base_position_m");
    if (position) start.q.head<3>() = position->as_vector3();
    if (const auto on = table->find("on")) {
      if (position) on->fail("need either on or base_position_m, not both");
      std::vector<std::string> names;
      for (const Surface& surface : surfaces) names.push_back(surface.name);
      put_on(surfaces[find_name(*on, "surface", names)], start);
    }
    read_velocity(*table, robot, start.v);
  }
  check_start(robot, start.q, joints, robot_file);
  return start;
}

void fit_contacts(const TomlTable& root, const RobotModel& robot, const std::vector<Surface>& surfaces,
                  const Phase& first, TaskStart& start) {
  put_contacts_down(robot, surfaces, first, start);
  stop_contacts(root, robot, first, start);
}

BoundaryConstraint start_constraint(const RobotModel& robot, const TaskStart& start) {
  BoundaryConstraint fixed = BoundaryConstraint::unbounded(robot, "start", PhaseFraction::start_of(0), start.q);
  fixed.configuration_lower.setZero();
  fixed.configuration_upper.setZero();
  fixed.velocity_lower = fixed.velocity_upper = start.v;
  return fixed;
}

}  // namespace prowl

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

/// Moves a posture from level ground, z = 0, to a surface: by the shortest rotation, the origin to
/// its point.
void put_on(const Surface& surface, TaskStart& start) {
  const Eigen::Matrix3d turn = so3::shortest_rotation(Eigen::Vector3d::UnitZ(), surface.normal);
  const Eigen::Matrix3d R = turn * base_rotation(start.q);
  start.q.head<3>() = (surface.point + turn * start.q.head<3>()).eval();
  set_base_rotation(start.q, R);
  start.rpy = rpy_from_rotation(R);
}

/// Reads one part of the start: its value, or the choice that the file leaves.
void read_part(const TomlValue& value, double& part, std::optional<TomlBounds>& choice) {
  const TomlBounds bounds = value.as_bounds();
  if (bounds.lower == bounds.upper) {
    part = bounds.lower;
  } else {
    choice = bounds;
  }
}

/// Reads three parts, the first of them number `first` among `choices`.
template <class Parts>
void read_parts3(const TomlValue& value, Parts&& parts, std::size_t first, StartChoices& choices) {
  const std::vector<TomlValue> entries = value.as_list(3);
  for (std::size_t i = 0; i < 3; ++i) read_part(entries[i], parts(static_cast<Eigen::Index>(i)), choices[first + i]);
}

std::size_t joint_index(const RobotModel& robot, const std::string& name) {
  const std::vector<std::string>& names = robot.joint_names();
  return static_cast<std::size_t>(std::ranges::find(names, name) - names.begin());
}

/// What a choice leaves of [lower, upper].
void narrow(std::optional<TomlBounds>& choice, const TomlValue& value, double lower, double upper) {
  if (!choice) return;
  if (choice->lower > upper || choice->upper < lower) {
    value.fail(fmt::format("outside the joint's limits; need some part of [{:.5g}, {:.5g}]", lower, upper));
  }
  choice = {std::max(choice->lower, lower), std::min(choice->upper, upper)};
}

void read_velocity(const TomlTable& table, const RobotModel& robot, TaskStart& start) {
  if (const auto linear = table.find("base_linear_velocity_mps"))
    read_parts3(*linear, start.v.head<3>(), 0, start.speed);
  if (const auto angular = table.find("base_angular_velocity_radps"))
    read_parts3(*angular, start.v.segment<3>(3), 3, start.speed);
  const auto rates = table.find("joint_velocity_radps");
  if (!rates) return;
  for (const auto& [name, value] : rates->as_named_values(robot.joint_names(), "joint")) {
    const std::size_t joint = joint_index(robot, name), row = 6 + joint;
    read_part(value, start.v(static_cast<Eigen::Index>(row)), start.speed[row]);
    const double limit = robot.velocity_limit()(static_cast<Eigen::Index>(joint));
    narrow(start.speed[row], value, -limit, limit);
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
    const PhaseContact& held = first.contacts[i];
    const Eigen::Vector3d position = footing.kinematics.positions().segment<3>(static_cast<Eigen::Index>(3 * i));
    const Surface& below = surfaces[static_cast<std::size_t>(held.surface)];
    const double gap = below.distance(position) - robot.contacts()[static_cast<std::size_t>(held.contact)].radius;
    targets.push_back({held.contact, position - gap * below.normal});
    largest = std::max(largest, std::abs(gap));
  }
  if (!(largest > kLeastGap && largest <= kLargestGap)) return;
  const InverseKinematics standing = inverse_kinematics(robot, start.q, targets);
  if (standing.converged) start.q = standing.q;
}

bool leaves_any(const StartChoices& choices) {
  return std::ranges::any_of(choices, [](const auto& choice) { return choice.has_value(); });
}

/// Where the base may vary, the joints between it and the contacts follow, except those that the file names.
void free_legs(const TomlTable& root, const RobotModel& robot, const Phase& first, TaskStart& start) {
  const auto table = root.find_table("start");
  const auto base = [](const StartChoices& choices) { return leaves_any({choices.begin(), choices.begin() + 6}); };
  const bool moves = base(start.pose), speeds = base(start.speed) || (moves && !start.v.isZero(0.0));
  if (!moves && !speeds) return;
  const auto is_named = [&](const char* key, std::size_t joint) {
    const auto named = table->find(key);
    return named && named->node().as_table()->contains(robot.joint_names()[joint]);
  };
  const Eigen::MatrixXd legs = Footing(robot, first, start).kinematics.jacobian().rightCols(robot.nu());
  for (std::size_t joint = 0; joint < robot.joint_names().size(); ++joint) {
    const auto j = static_cast<Eigen::Index>(joint);
    if (legs.col(j).isZero(0.0)) continue;
    if (moves && !is_named("joints", joint))
      start.pose[6 + joint] = {robot.position_lower()(j), robot.position_upper()(j)};
    if (speeds && !is_named("joint_velocity_radps", joint))
      start.speed[6 + joint] = {-robot.velocity_limit()(j), robot.velocity_limit()(j)};
  }
}

void stop_contacts(const TomlTable& root, const RobotModel& robot, const Phase& first, TaskStart& start) {
  if (start.v.isZero(0.0) || leaves_any(start.speed)) return;
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
  const StartChoices fixed(static_cast<std::size_t>(robot.nv()));
  TaskStart start{robot.nominal_configuration(), Eigen::VectorXd::Zero(robot.nv()),
                  robot.description().nominal_base_rpy, fixed, fixed};
  std::optional<TomlValue> joints;
  if (const auto table = root.find_table("start")) {
    RobotDescription posture = robot.description();
    joints = table->find("joints");
    if (joints) {
      for (const auto& [name, value] : joints->as_named_values(robot.joint_names(), "joint")) {
        const std::size_t joint = joint_index(robot, name);
        read_part(value, posture.nominal_joints[name], start.pose[6 + joint]);
        const auto j = static_cast<Eigen::Index>(joint);
        narrow(start.pose[6 + joint], value, robot.position_lower()(j), robot.position_upper()(j));
      }
    }
    if (const auto rpy = table->find("base_rpy_rad")) {
      read_parts3(*rpy, posture.nominal_base_rpy, 3, start.pose);
      for (int i = 0; i < 3; ++i) {
        const double angle = posture.nominal_base_rpy(i);
        if (auto& turn = start.pose[static_cast<std::size_t>(3 + i)]) turn = {turn->lower - angle, turn->upper - angle};
      }
    }
    // RobotModel puts its nominal posture on the ground.
    start.q = RobotModel(posture).nominal_configuration();
    start.rpy = posture.nominal_base_rpy;
    const auto position = table->find("base_position_m");
    if (position) read_parts3(*position, start.q.head<3>(), 0, start.pose);
    if (const auto on = table->find("on")) {
      if (position) on->fail("need either on or base_position_m, not both");
      std::vector<std::string> names;
      for (const Surface& surface : surfaces) names.push_back(surface.name);
      put_on(surfaces[on->as_one_of("surface", names)], start);
    }
    read_velocity(*table, robot, start);
  }
  check_start(robot, start.q, joints, robot_file);
  return start;
}

void fit_contacts(const TomlTable& root, const RobotModel& robot, const std::vector<Surface>& surfaces,
                  const Phase& first, TaskStart& start) {
  put_contacts_down(robot, surfaces, first, start);
  free_legs(root, robot, first, start);
  stop_contacts(root, robot, first, start);
}

BoundaryConstraint start_constraint(const RobotModel& robot, const TaskStart& start) {
  BoundaryConstraint constraint = BoundaryConstraint::unbounded(robot, "start", PhaseFraction::start_of(0), start.q);
  Eigen::VectorXd values(robot.nv());
  values << base_position(start.q), Eigen::Vector3d::Zero(), start.q.tail(robot.nu());
  for (Eigen::Index i = 0; i < robot.nv(); ++i) {
    const auto& pose = start.pose[static_cast<std::size_t>(i)];
    const auto& speed = start.speed[static_cast<std::size_t>(i)];
    constraint.configuration_lower(i) = pose ? pose->lower - values(i) : 0.0;
    constraint.configuration_upper(i) = pose ? pose->upper - values(i) : 0.0;
    constraint.velocity_lower(i) = speed ? speed->lower : start.v(i);
    constraint.velocity_upper(i) = speed ? speed->upper : start.v(i);
  }
  return constraint;
}

}  // namespace prowl

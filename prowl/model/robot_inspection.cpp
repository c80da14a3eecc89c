#include "prowl/model/robot_inspection.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>

#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/mirror_name.hpp"
#include "prowl/model/physical_inertia.hpp"
#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

namespace {

using Kind = RobotWarning::Kind;
using Warnings = std::vector<RobotWarning>;

constexpr double kLevel = 1e-3;     // [m]
constexpr double kRelative = 1e-3;  // of masses and limits, left against right
constexpr double kTinyMass = 1e-5;  // of the robot's mass
// Relative to the largest singular value: zero at or below the threshold; ambiguous between the other two.
constexpr double kRankThreshold = 1e-8, kSurelyZero = 1e-10, kSurelyNot = 1e-6;

bool nearly_equal(double a, double b) {
  return std::abs(a - b) <= kRelative * std::max({std::abs(a), std::abs(b), 1e-3});
}

/// One warning for all joints with the same flaw.
void warn_of_joints(const RobotModel& robot, Kind kind, const std::string& flaw,
                    const std::function<bool(Eigen::Index)>& has_flaw, Warnings& warnings) {
  std::vector<std::string> joints;
  for (Eigen::Index j = 0; j < robot.nu(); ++j) {
    if (has_flaw(j)) joints.push_back(robot.joint_names()[j]);
  }
  if (!joints.empty()) warnings.push_back({kind, fmt::format("{}: {}", flaw, fmt::join(joints, ", "))});
}

/// Such links are harmless in Prowl, because fixed joints merge them with heavier ones or they carry others (RobotModel
/// refuses the rest), but not in every simulator.
void check_inertias(const RobotModel& robot, Warnings& warnings) {
  std::vector<std::string> tiny;
  for (const UrdfLink& link : robot.pinocchio().urdf.links) {
    if (link.mass == 0.0 && link.inertia.isZero(0.0)) continue;  // a frame, written as a link
    if (link.mass < kTinyMass * robot.mass()) {
      tiny.push_back(fmt::format("{} {} kg", link.name, link.mass));
    } else if (const auto problem = why_not_physical(link.mass, link.inertia)) {
      warnings.push_back({Kind::inertia, fmt::format("link '{}': {}", link.name, *problem)});
    }
  }
  if (!tiny.empty()) {
    warnings.push_back(
        {Kind::inertia, fmt::format("links with an inertia but almost no mass: {}", fmt::join(tiny, ", "))});
  }
  warn_of_joints(
      robot, Kind::inertia, "joints that move a body without an inertia of its own, and others beyond it",
      [&](Eigen::Index j) {
        const pinocchio::Inertia& body = robot.pinocchio().model.inertias[static_cast<std::size_t>(j) + kBaseJoint + 1];
        return lacks_inertia(body.mass(), body.inertia().matrix());
      },
      warnings);
}

void check_mimics(const RobotModel& robot, Warnings& warnings) {
  const std::vector<std::string>& mimics = robot.pinocchio().urdf.mimics;
  if (mimics.empty()) return;
  warnings.push_back({Kind::mimic, fmt::format("joints that copy others are locked: {}", fmt::join(mimics, ", "))});
}

void inspect_limits(const RobotModel& robot, Warnings& warnings) {
  warn_of_joints(
      robot, Kind::limit, fmt::format("torque limit of {} N m (or N) or more is no limit", kNoRealLimit),
      [&](Eigen::Index j) { return robot.torque_limit()(j) >= kNoRealLimit; }, warnings);
  warn_of_joints(
      robot, Kind::limit, fmt::format("velocity limit of {} rad/s (or m/s) or more is no limit", kNoRealLimit),
      [&](Eigen::Index j) { return robot.velocity_limit()(j) >= kNoRealLimit; }, warnings);
  warn_of_joints(
      robot, Kind::limit, "position range beyond +-2 pi rad (or +-1000 m) is no limit",
      [&](Eigen::Index j) {
        const bool prismatic = robot.joint_is_prismatic()[j];
        const double most = prismatic ? kNoRealLimit : 2.0 * std::numbers::pi;
        return robot.position_lower()(j) < -most || robot.position_upper()(j) > most;
      },
      warnings);
}

void check_posture(const RobotModel& robot, Warnings& warnings) {
  const Eigen::VectorXd joints = robot.nominal_configuration().tail(robot.nu());
  warn_of_joints(
      robot, Kind::posture, "nominal posture outside the joint limits",
      [&](Eigen::Index j) { return joints(j) < robot.position_lower()(j) || joints(j) > robot.position_upper()(j); },
      warnings);
}

void check_ground(const RobotModel& robot, const std::vector<Eigen::Vector3d>& points, Warnings& warnings) {
  std::vector<std::string> heights;
  double highest = 0.0;  // the lowest is at 0: RobotModel puts it there
  for (std::size_t c = 0; c < points.size(); ++c) {
    const double height = points[c].z() - robot.contacts()[c].radius;
    highest = std::max(highest, height);
    heights.push_back(fmt::format("{} {:.1f} mm", robot.contacts()[c].name, 1e3 * height));
  }
  if (highest <= kLevel) return;
  warnings.push_back(
      {Kind::ground, fmt::format("contacts are not level in the nominal posture; heights above the ground: {}",
                                 fmt::join(heights, ", "))});
}

void check_coincidence(const RobotModel& robot, const std::vector<Eigen::Vector3d>& points, Warnings& warnings) {
  for (std::size_t a = 0; a < points.size(); ++a) {
    for (std::size_t b = a + 1; b < points.size(); ++b) {
      if ((points[a] - points[b]).norm() > kLevel) continue;
      warnings.push_back({Kind::contacts, fmt::format("contacts '{}' and '{}' are one point", robot.contacts()[a].name,
                                                      robot.contacts()[b].name)});
    }
  }
}

/// True if right has the limits of left, equal or mirrored.
bool same_range(const RobotModel& robot, Eigen::Index left, Eigen::Index right) {
  const double lower = robot.position_lower()(left), upper = robot.position_upper()(left);
  const double right_lower = robot.position_lower()(right), right_upper = robot.position_upper()(right);
  return (nearly_equal(lower, right_lower) && nearly_equal(upper, right_upper)) ||
         (nearly_equal(lower, -right_upper) && nearly_equal(upper, -right_lower));
}

void check_joint_symmetry(const RobotModel& robot, Warnings& warnings) {
  const std::vector<std::string>& names = robot.joint_names();
  const pinocchio::Model& model = robot.pinocchio().model;
  for (Eigen::Index l = 0; l < robot.nu(); ++l) {
    const std::string& left = names[l];
    const auto right = right_counterpart(left, names);
    if (!right) continue;
    const Eigen::Index r = std::find(names.begin(), names.end(), *right) - names.begin();
    const auto warn = [&](const std::string& what) {
      warnings.push_back({Kind::symmetry, fmt::format("'{}' and '{}' differ in {}", left, *right, what)});
    };
    const auto compare = [&](const char* what, double a, double b, const char* unit) {
      if (!nearly_equal(a, b)) warn(fmt::format("{}: {:.6g} and {:.6g} {}", what, a, b, unit));
    };
    compare("torque limit", robot.torque_limit()(l), robot.torque_limit()(r), "N m");
    compare("velocity limit", robot.velocity_limit()(l), robot.velocity_limit()(r), "rad/s");
    compare("the mass they move", model.inertias[model.getJointId(left)].mass(),
            model.inertias[model.getJointId(*right)].mass(), "kg");
    if (!same_range(robot, l, r)) {
      warn(fmt::format("position range: {:.4g} to {:.4g} and {:.4g} to {:.4g} rad", robot.position_lower()(l),
                       robot.position_upper()(l), robot.position_lower()(r), robot.position_upper()(r)));
    }
  }
}

/// Mirrored contacts, seen from the base, must be mirrored points. (Joint angles may or may not change sign.)
void check_contact_symmetry(const RobotModel& robot, const std::vector<Eigen::Vector3d>& points, Warnings& warnings) {
  std::vector<std::string> names;
  for (const ContactPoint& contact : robot.contacts()) names.push_back(contact.name);
  const Eigen::VectorXd& q = robot.nominal_configuration();
  const auto from_base = [&](std::size_t c) -> Eigen::Vector3d {
    return base_rotation(q).transpose() * (points[c] - base_position(q));
  };
  for (std::size_t l = 0; l < names.size(); ++l) {
    const auto right = right_counterpart(names[l], names);
    if (!right) continue;
    const auto r = static_cast<std::size_t>(std::find(names.begin(), names.end(), *right) - names.begin());
    const Eigen::Vector3d mirrored = from_base(r).cwiseProduct(Eigen::Vector3d(1.0, -1.0, 1.0));
    const Eigen::Vector3d apart = from_base(l) - mirrored;
    if (apart.norm() <= kLevel) continue;
    warnings.push_back({Kind::symmetry, fmt::format("nominal posture: '{}' and the mirror image of '{}' are {:.1f} mm "
                                                    "apart",
                                                    names[l], *right, 1e3 * apart.norm())});
  }
}

Eigen::MatrixXd contact_jacobian(const PinocchioModel& pin, pinocchio::Data& data, const Eigen::VectorXd& q) {
  pinocchio::computeJointJacobians(pin.model, data, q);
  Eigen::MatrixXd J(3 * pin.contact_frames.size(), pin.model.nv);
  for (std::size_t c = 0; c < pin.contact_frames.size(); ++c) {
    Eigen::Matrix<double, 6, Eigen::Dynamic> spatial = Eigen::MatrixXd::Zero(6, pin.model.nv);
    pinocchio::getFrameJacobian(pin.model, data, pin.contact_frames[c], pinocchio::LOCAL_WORLD_ALIGNED, spatial);
    J.middleRows<3>(static_cast<Eigen::Index>(3 * c)) = spatial.topRows<3>();
  }
  return J;
}

}  // namespace

std::vector<std::string> contact_frame_names(const RobotModel& robot) {
  std::vector<std::string> names;
  for (const pinocchio::Frame& frame : robot.pinocchio().model.frames) {
    if ((frame.type & (pinocchio::BODY | pinocchio::FIXED_JOINT)) != 0 && frame.name != "universe")
      names.push_back(frame.name);
  }
  return names;
}

std::vector<std::string> implausible_sizes(const RobotModel& robot) {
  constexpr double kLargestBall = 0.25;              // of the robot's size; ten times that of usual feet
  constexpr double kThinnest = 1.0, kDensest = 1e4;  // [kg/m^3], of a cube as large as the robot; ours have 50 to 500
  std::vector<std::string> lines;
  const double size = robot.size(), density = robot.mass() / (size * size * size);
  if (!robot.contacts().empty() && (density < kThinnest || density > kDensest)) {
    lines.push_back(fmt::format("{:.3g} kg, and contacts {:.3g} m from the base: is the robot in kilograms and metres?",
                                robot.mass(), size));
  }
  for (const ContactPoint& contact : robot.contacts()) {
    if (contact.radius <= kLargestBall * size) continue;
    lines.push_back(
        fmt::format("contact '{}' has a radius of {:.3g} m, and is {:.3g} m from the base: is it in metres?",
                    contact.name, contact.radius, size));
  }
  return lines;
}

RobotInspection inspect(const RobotModel& robot) {
  const PinocchioModel& pin = robot.pinocchio();
  const Eigen::VectorXd& q = robot.nominal_configuration();
  pinocchio::Data data(pin.model);
  pinocchio::framesForwardKinematics(pin.model, data, q);
  std::vector<Eigen::Vector3d> points;
  for (const pinocchio::FrameIndex frame : pin.contact_frames) points.push_back(data.oMf[frame].translation());

  RobotInspection result;
  check_inertias(robot, result.warnings);
  check_mimics(robot, result.warnings);
  inspect_limits(robot, result.warnings);
  check_ground(robot, points, result.warnings);
  check_coincidence(robot, points, result.warnings);
  check_joint_symmetry(robot, result.warnings);
  check_contact_symmetry(robot, points, result.warnings);
  check_posture(robot, result.warnings);
  for (std::string& text : implausible_sizes(robot)) result.warnings.push_back({Kind::size, std::move(text)});

  result.contact_rows = static_cast<int>(3 * points.size());
  if (points.empty()) return result;
  result.contact_singular_values = singular_values(contact_jacobian(pin, data, q));
  const Eigen::ArrayXd ratios = result.contact_singular_values.array() / result.contact_singular_values(0);
  result.contact_rank = static_cast<int>((ratios > kRankThreshold).count());
  for (const double ratio : ratios) {
    if (ratio <= kSurelyZero || ratio >= kSurelyNot) continue;
    result.warnings.push_back(
        {Kind::contacts, fmt::format("rank of the contact Jacobian is ambiguous: a singular value "
                                     "is {:.1e} times the largest; move or drop a contact point",
                                     ratio)});
  }
  return result;
}

}  // namespace prowl

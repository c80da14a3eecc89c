#include "screen/robot_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "prowl/files/json_text.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

std::string limit(double value, const std::string& unit) {
  return std::isfinite(value) ? fmt::format("{:.4g} {}", value, unit) : "none";
}

/// No "-0.0000" for a rounding error.
double without_sign(double value) { return std::abs(value) < 5e-5 ? 0.0 : value; }

using Row = std::vector<std::string>;

/// As wide as it must be; the first `left` columns begin at their left end, the others end at their right.
std::string aligned(const std::vector<Row>& rows, std::size_t left) {
  std::string text;
  for (const Row& row : rows) {
    for (std::size_t c = 0; c < row.size(); ++c) {
      std::size_t width = 0;
      for (const Row& other : rows) width = std::max(width, other[c].size());
      text += c < left ? fmt::format("  {:<{}}", row[c], width) : fmt::format("  {:>{}}", row[c], width);
    }
    text += '\n';
  }
  return text;
}

std::string contact_table(const RobotModel& robot) {
  if (robot.contacts().empty()) return "no contacts; frames for them: prowl robot --frames\n";
  const ContactPoint& first = robot.contacts().front();
  const auto is_like_first = [&first](const ContactPoint& contact) {
    return contact.frame == contact.name && contact.radius == first.radius && contact.offset == first.offset;
  };
  if (std::ranges::all_of(robot.contacts(), is_like_first)) {
    std::vector<std::string> names;
    for (const ContactPoint& contact : robot.contacts()) names.push_back(contact.name);
    return fmt::format("  contacts: {}\n    in the frames of these names, radius {:g} m, offset {:g} {:g} {:g} m\n",
                       fmt::join(names, ", "), first.radius, first.offset.x(), first.offset.y(), first.offset.z());
  }
  std::vector<Row> rows = {{"contact", "frame", "radius", "offset"}};
  for (const ContactPoint& contact : robot.contacts()) {
    rows.push_back({contact.name, contact.frame, fmt::format("{:g} m", contact.radius),
                    fmt::format("{:g} {:g} {:g} m", contact.offset.x(), contact.offset.y(), contact.offset.z())});
  }
  return aligned(rows, 2);
}

/// The largest losses of a joint; each is in --json.
std::string losses(const RobotModel& robot) {
  const JointLosses& all = robot.losses();
  if (!all.any()) return "";
  return fmt::format("  losses of joints: damping up to {:g} N m s/rad, friction up to {:g} N m\n",
                     all.damping.maxCoeff(), all.dry_friction.maxCoeff());
}

std::string joint_table(const RobotModel& robot) {
  std::vector<Row> rows = {{"joint", "#", "nominal", "position", "velocity", "torque"}};
  for (int j = 0; j < robot.nu(); ++j) {
    const bool slides = robot.joint_is_prismatic()[j];
    const std::string length = slides ? "m" : "rad";
    rows.push_back({robot.joint_names()[j], fmt::format("{}", j), limit(robot.nominal_configuration()(7 + j), length),
                    fmt::format("{:.4g} ... {:.4g}", robot.position_lower()(j), robot.position_upper()(j)),
                    limit(robot.velocity_limit()(j), length + "/s"),
                    limit(robot.torque_limit()(j), slides ? "N" : "N m")});
  }
  return aligned(rows, 1) + losses(robot);
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json vector_to_json(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

Json joints_to_json(const RobotModel& robot) {
  Json joints = Json::array();
  for (int j = 0; j < robot.nu(); ++j) {
    joints.push_back({{"name", robot.joint_names()[j]},
                      {"type", robot.joint_is_prismatic()[j] ? "prismatic" : "revolute"},
                      {"position_lower", number_or_null(robot.position_lower()(j))},
                      {"position_upper", number_or_null(robot.position_upper()(j))},
                      {"velocity_limit", number_or_null(robot.velocity_limit()(j))},
                      {"torque_limit", number_or_null(robot.torque_limit()(j))},
                      {"damping", robot.losses().damping(j)},
                      {"friction", robot.losses().dry_friction(j)}});
  }
  return joints;
}

}  // namespace

std::string robot_summary(const RobotModel& robot, const RobotInspection& inspection) {
  const Eigen::VectorXd& q = robot.nominal_configuration();
  std::string text = fmt::format("{}: {:.3f} kg, {} joints, {} velocities with the base\n", robot.name(), robot.mass(),
                                 robot.nu(), robot.nv());
  text += fmt::format("  URDF {}\n", robot.description().urdf.string());
  text += joint_table(robot);
  const std::vector<std::string>& locked = robot.description().locked_joints;
  if (!locked.empty()) text += fmt::format("  locked: {}\n", fmt::join(locked, ", "));
  text += contact_table(robot);
  text += fmt::format("nominal posture: base at {:.4f} {:.4f} {:.4f} m", without_sign(q(0)), without_sign(q(1)),
                      without_sign(q(2)));
  if (!robot.contacts().empty()) {
    text += fmt::format("; contacts: {} rows, rank {}{}", inspection.contact_rows, inspection.contact_rank,
                        inspection.contact_rank < inspection.contact_rows ? " (redundant contacts)" : "");
  }
  text += inspection.warnings.empty() ? "\nno warnings\n" : "\n";
  for (const RobotWarning& warning : inspection.warnings) text += fmt::format("warning: {}\n", warning.text);
  return text;
}

std::string frame_list(const RobotModel& robot) {
  std::string text = "\nframes that a contact may be fixed to\n";
  for (const std::string& name : contact_frame_names(robot)) text += "  " + name + "\n";
  return text;
}

std::string robot_report_json(const RobotModel& robot, const RobotInspection& inspection) {
  Json contacts = Json::array();
  for (const ContactPoint& contact : robot.contacts()) {
    contacts.push_back({{"name", contact.name},
                        {"frame", contact.frame},
                        {"radius_m", contact.radius},
                        {"offset_m", vector_to_json(contact.offset)}});
  }
  Json warnings = Json::array();
  for (const RobotWarning& warning : inspection.warnings) warnings.push_back(warning.text);
  const Json report = {{"name", robot.name()},
                       {"urdf", robot.description().urdf.string()},
                       {"mass_kg", robot.mass()},
                       {"joints", joints_to_json(robot)},
                       {"locked_joints", robot.description().locked_joints},
                       {"contacts", contacts},
                       {"frames", contact_frame_names(robot)},
                       {"nominal_configuration", vector_to_json(robot.nominal_configuration())},
                       {"contact_rows", inspection.contact_rows},
                       {"contact_rank", inspection.contact_rank},
                       {"contact_singular_values", vector_to_json(inspection.contact_singular_values)},
                       {"warnings", warnings}};
  return json_text(report);
}

}  // namespace prowl

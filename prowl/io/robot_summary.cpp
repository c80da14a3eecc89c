#include "prowl/io/robot_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/io/json_text.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

std::string limit(double value, const std::string& unit) {
  return std::isfinite(value) ? fmt::format("{:.4g} {}", value, unit) : "none";
}

/// No "-0.0000" for a rounding error.
double without_sign(double value) { return std::abs(value) < 5e-5 ? 0.0 : value; }

std::string contact_table(const RobotModel& robot) {
  if (robot.contacts().empty()) return "\nno contacts; frames for them: prowl robot --frames\n";
  std::size_t name_width = 0, frame_width = 0;
  for (const ContactPoint& contact : robot.contacts()) {
    name_width = std::max(name_width, contact.name.size());
    frame_width = std::max(frame_width, contact.frame.size());
  }
  std::string text = "\ncontacts\n";
  for (const ContactPoint& contact : robot.contacts()) {
    text += fmt::format("  {:<{}}  frame {:<{}}  radius {:g} m, offset {:g} {:g} {:g} m\n", contact.name, name_width,
                        contact.frame, frame_width, contact.radius, contact.offset.x(), contact.offset.y(),
                        contact.offset.z());
  }
  return text;
}

std::string joint_table(const RobotModel& robot) {
  std::size_t width = 5;
  for (const std::string& name : robot.joint_names()) width = std::max(width, name.size());
  std::string text = fmt::format("  {:>2}  {:<{}}  {:>13}  {:>24}  {:>12}  {:>12}\n", "#", "joint", width, "nominal",
                                 "position", "velocity", "torque");
  for (int j = 0; j < robot.nu(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    const bool slides = robot.joint_is_prismatic()[i];
    const std::string length = slides ? "m" : "rad";
    const std::string range =
        fmt::format("{:.4g} ... {:.4g} {}", robot.position_lower()(j), robot.position_upper()(j), length);
    text += fmt::format("  {:>2}  {:<{}}  {:>13}  {:>24}  {:>12}  {:>12}\n", j, robot.joint_names()[i], width,
                        limit(robot.nominal_configuration()(7 + j), length), range,
                        limit(robot.velocity_limit()(j), length + "/s"),
                        limit(robot.torque_limit()(j), slides ? "N" : "N m"));
  }
  return text;
}

Json number_or_null(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

Json vector_to_json(const Eigen::VectorXd& values) { return std::vector<double>(values.begin(), values.end()); }

Json joints_to_json(const RobotModel& robot) {
  Json joints = Json::array();
  for (int j = 0; j < robot.nu(); ++j) {
    const auto i = static_cast<std::size_t>(j);
    joints.push_back({{"name", robot.joint_names()[i]},
                      {"type", robot.joint_is_prismatic()[i] ? "prismatic" : "revolute"},
                      {"position_lower", number_or_null(robot.position_lower()(j))},
                      {"position_upper", number_or_null(robot.position_upper()(j))},
                      {"velocity_limit", number_or_null(robot.velocity_limit()(j))},
                      {"torque_limit", number_or_null(robot.torque_limit()(j))}});
  }
  return joints;
}

}  // namespace

std::string robot_summary(const RobotModel& robot, const RobotInspection& inspection) {
  const Eigen::VectorXd& q = robot.nominal_configuration();
  std::string text = fmt::format("{}: {:.3f} kg, {} joints, {} velocities with the base\n", robot.name(), robot.mass(),
                                 robot.nu(), robot.nv());
  text += fmt::format("  URDF {}\n\n", robot.description().urdf.string());
  text += joint_table(robot);
  text += contact_table(robot);
  text += fmt::format("\nnominal posture: base at {:.4f} {:.4f} {:.4f} m\n", without_sign(q(0)), without_sign(q(1)),
                      without_sign(q(2)));
  if (!robot.contacts().empty()) {
    text +=
        fmt::format("contact Jacobian there: {} rows, rank {}{}\n", inspection.contact_rows, inspection.contact_rank,
                    inspection.contact_rank < inspection.contact_rows ? " (redundant contacts)" : "");
  }
  text += inspection.warnings.empty() ? "no warnings\n" : "\n";
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

#include "prowl/task_file/robot_file.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"
#include "prowl/model/description_error.hpp"
#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {
namespace {

ContactPoint read_contact(const TomlTable& table) {
  ContactPoint contact;
  contact.name = table.need("name").as_name();
  contact.frame = table.need("frame").as_text();
  if (const auto radius = table.find("radius_m")) contact.radius = radius->as_number();
  if (const auto offset = table.find("offset_m")) contact.offset = offset->as_vector3();
  return contact;
}

std::vector<ContactPoint> read_contacts(const TomlTable& root, bool needed) {
  if (!needed && !root.find("contact")) return {};
  root.need("contact");
  std::vector<ContactPoint> contacts;
  constexpr std::size_t kMostContacts = 100;  // each is a frame of the model; two hands and feet of 20 points need 80
  for (const TomlTable& table : root.find_tables("contact", kMostContacts)) {
    const ContactPoint contact = read_contact(table);
    for (const ContactPoint& other : contacts) {
      if (other.name == contact.name) table.need("name").fail("\"" + contact.name + "\" is already another contact");
    }
    contacts.push_back(contact);
  }
  if (contacts.empty()) root.need("contact").fail("an empty list is not allowed; need one contact or more");
  return contacts;
}

void read_nominal(const TomlTable& table, RobotDescription& robot) {
  if (const auto rpy = table.find("base_rpy_rad")) robot.nominal_base_rpy = rpy->as_vector3();
  if (const auto joints = table.find("joints")) {
    for (const auto& [name, value] : joints->as_free_named_values("joint")) {
      robot.nominal_joints[name] = value.as_number();
    }
  }
}

LimitCurve::Table read_curve(const TomlValue& value) {
  LimitCurve::Table table;
  for (const TomlValue& point : value.as_list()) {
    const std::vector<TomlValue> entries = point.as_list(2);
    table.emplace_back(entries[0].as_number(), entries[1].as_number(NumberRange::positive()));
  }
  try {
    LimitCurve{table};
  } catch (const InputError& error) {
    value.fail(error.what());
  }
  return table;
}

JointLimits read_limits(const TomlTable& table) {
  JointLimits limits;
  if (const auto position = table.find("position_rad")) {
    const std::vector<TomlValue> ends = position->as_list(2);
    limits.position_lower = ends[0].as_number();
    limits.position_upper = ends[1].as_number();
    if (*limits.position_lower > *limits.position_upper) position->fail("min > max is not allowed; need [min, max]");
  }
  if (const auto velocity = table.find("velocity_radps")) limits.velocity = velocity->as_number();
  if (const auto torque = table.find("torque_Nm")) limits.torque = torque->as_number();
  if (const auto curve = table.find("torque_over_position")) limits.torque_over_position = read_curve(*curve);
  if (const auto curve = table.find("negative_torque_over_position"))
    limits.negative_torque_over_position = read_curve(*curve);
  if (const auto curve = table.find("torque_over_velocity")) limits.torque_over_velocity = read_curve(*curve);
  return limits;
}

/// Location of a key in a robot file: of its name for joints, which may not exist, else of its
/// value.
std::string location_of_key(const SourceText& source, const std::string& key) {
  const bool is_joint = key.starts_with("limits.") || key.starts_with("nominal.") || key.starts_with("armature.");
  return (is_joint ? locate_key(source, key) : locate(source, key)) + key;
}

}  // namespace

namespace {

RobotDescription read_robot(const TomlDocument& document, const SourceText& source, const PackageSearch& search,
                            const RobotFileOptions& options) {
  document.refuse_key("phase", "this looks like a task file; need the robot file that it names");
  const TomlTable root = document.root(robot_file_keys());
  RobotDescription robot;
  robot.name = root.need("name").as_name();
  robot.contacts = read_contacts(root, options.needs_contacts);
  if (const auto locked = root.find("locked_joints")) {
    for (const TomlValue& joint : locked->as_list()) robot.locked_joints.push_back(joint.as_text());
  }
  if (const auto armature = root.find("armature")) {
    for (const auto& [joint, value] : armature->as_free_named_values("joint"))
      robot.armature[joint] = value.as_number(NumberRange::nonnegative());
  }
  if (const auto nominal = root.find_table("nominal")) read_nominal(*nominal, robot);
  if (const auto limits = root.find("limits")) {
    for (const auto& [joint, value] : limits->as_free_named_values("joint")) {
      robot.limits[joint] = read_limits(TomlTable(value, robot_file_keys(), "limits"));
    }
  }
  std::vector<std::filesystem::path> package_dirs;
  if (const auto dirs = root.find("package_dirs")) {
    for (const TomlValue& dir : dirs->as_list()) package_dirs.push_back(source.path.parent_path() / dir.as_text());
  }
  const TomlValue urdf = root.need("urdf");
  const std::string uri = urdf.as_text();
  try {
    robot.urdf = resolve_uri(uri, source.path, package_dirs, search);
  } catch (const InputError& error) {
    if (!options.urdf_copy) urdf.fail(error.what());
    robot.urdf = options.urdf_copy->path;
    robot.urdf_text = options.urdf_copy->text;
  }
  return robot;
}

}  // namespace

RobotDescription parse_robot_file(const SourceText& source, const PackageSearch& search,
                                  const RobotFileOptions& options) {
  const TomlDocument document(source);
  return document.read_with([&] { return read_robot(document, source, search, options); });
}

RobotDescription read_robot_file(const std::filesystem::path& path, const PackageSearch& search) {
  return parse_robot_file(read_text_file(path), search);
}

RobotModel load_robot(const SourceText& source, const PackageSearch& search, const RobotFileOptions& options) {
  const RobotDescription description = parse_robot_file(source, search, options);
  try {
    return RobotModel(description);
  } catch (const DescriptionError& error) {
    throw InputError(fmt::format("{}: {}", location_of_key(source, error.key()), error.what()));
  } catch (const InputError& error) {
    throw InputError(fmt::format("{}: {}", location_of_key(source, "urdf"), error.what()));
  }
}

}  // namespace prowl

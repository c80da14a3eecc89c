#include "prowl/starter/robot_template.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "prowl/error.hpp"
#include "prowl/task_file/toml/toml_text.hpp"

namespace prowl {
namespace {

namespace fs = std::filesystem;

constexpr const char* kRobotHead =
    R"(# {name}: {mass:.1f} kg, {legs} legs. Written by `prowl new robot` from the URDF. Check everything marked "guess":
# `prowl robot {file}` shows how Prowl reads this file, and warns. All keys: docs/robot-file.md.
name = "{name}"

# A path is relative to this file; package://NAME/PATH is searched in --package-dir, ROS_PACKAGE_PATH and others.
urdf = {urdf}

# Contacts, guess: the ends of the {legs} limbs that reach furthest down with all joints near 0.{others}
# You can add others, on any link or fixed joint: `prowl robot {file} --frames` lists them.
)";

constexpr const char* kContact = R"([[contact]]
name = "{name}"
frame = "{frame}"
)";

constexpr const char* kPosture =
    R"(# Start posture of motions, guess: by inverse kinematics, all contacts on the ground below the hips, legs
# stretched to {stretch:.0f} % of their length, knees {knees} if the limits allow both ways.
# The height of the base is then {height:.3f} m. Standing takes {torque}.
# A `group_state` of the robot's SRDF may be better ("standing"). Keep joints inside their limits and knees bent.
)";

constexpr const char* kNoPosture =
    R"(# Start posture of motions: NOT FOUND. No posture with bent knees puts all contacts on level ground below the hips.
# These are joint positions near 0 within the limits. Change them until `prowl robot {file}` gives no warning.
)";

constexpr const char* kLimits =
    R"(# Limits: the URDF's, except those below, which were missing or placeholders that limit nothing. These are guesses:
# replace them by the maker's data sheet, and name it. The ranges keep each knee on its own side.
)";

constexpr const char* kAllLimits =
    "# Limits: the URDF's. [limits.JOINT] replaces them one by one: docs/robot-file.md.\n";

std::string number(double x) {
  const std::string text = fmt::format("{:.6g}", x);
  return text.find_first_of(".en") == std::string::npos ? text + ".0" : text;
}

/// For a comment: file names may contain any character.
std::string one_line(std::string text) {
  std::replace_if(text.begin(), text.end(), [](unsigned char c) { return c < 0x20 || c == 0x7f; }, ' ');
  return text;
}

/// A TOML key, quoted if necessary.
std::string key(const std::string& name) {
  const bool bare =
      name.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-") == std::string::npos;
  return bare ? name : '"' + name + '"';
}

std::string contacts(const NewRobot& robot) {
  std::string text, last;
  for (const FootContacts& foot : robot.feet) {
    if (foot.how != last) text += fmt::format("# Position and size: {}.\n", one_line(foot.how));
    last = foot.how;
    for (const ContactPoint& contact : foot.contacts) {
      text += fmt::format(fmt::runtime(kContact), fmt::arg("name", contact.name), fmt::arg("frame", contact.frame));
      if (contact.radius > 0.0) text += fmt::format("radius_m = {}\n", number(contact.radius));
      if (!contact.offset.isZero(0.0)) {
        text += fmt::format("offset_m = [{}, {}, {}]\n", number(contact.offset.x()), number(contact.offset.y()),
                            number(contact.offset.z()));
      }
      text += '\n';
    }
  }
  return text;
}

std::string torque_in_words(const NewRobot& robot) {
  const bool placeholders =
      std::any_of(robot.limits.begin(), robot.limits.end(), [](const LimitGuess& g) { return g.torque_is_no_limit; });
  if (placeholders) return "torques without a limit to compare with: the URDF has none";
  return fmt::format("{:.0f} % of the torque limits at most ({})", 100.0 * robot.torque_share, robot.torque_joint);
}

std::string posture(const NewRobot& robot, const fs::path& file) {
  std::string text;
  if (robot.posture.found) {
    text = fmt::format(fmt::runtime(kPosture), fmt::arg("stretch", 100.0 * robot.posture.stretch),
                       fmt::arg("knees", robot.search.legs.size() > 2 ? "towards the middle of the robot" : "forward"),
                       fmt::arg("height", robot.posture.height), fmt::arg("torque", torque_in_words(robot)));
  } else {
    text = fmt::format(fmt::runtime(kNoPosture), fmt::arg("file", one_line(file.string())));
  }
  const Eigen::Vector3d& rpy = robot.search.base_rpy;
  if (!rpy.isZero(0.0)) {
    text += fmt::format(
        "[nominal]   # guess: the legs do not hang along -z of the base\nbase_rpy_rad = [{}, {}, "
        "{}]\n\n",
        number(rpy.x()), number(rpy.y()), number(rpy.z()));
  }
  text += "[nominal.joints]   # [rad]; others are 0\n";
  for (const auto& [joint, position] : robot.description.nominal_joints) {
    if (position != 0.0) text += fmt::format("{} = {}\n", key(joint), number(position));
  }
  return text + "\n";
}

std::string armature(const NewRobot& robot) {
  if (robot.description.armature.empty()) return "";
  std::string text = "[armature]   # inertia of the motors [kg m²], of the MJCF\n";
  for (const auto& [joint, inertia] : robot.description.armature) text += fmt::format("{} = {}\n", key(joint), inertia);
  return text + "\n";
}

std::string limits(const NewRobot& robot) {
  if (robot.limits.empty()) return kAllLimits;
  std::string text = kLimits;
  for (const LimitGuess& guess : robot.limits) {
    text += fmt::format("[limits.{}]\n", key(guess.joint));
    if (guess.position) {
      text += fmt::format("position_rad = [{}, {}]{}\n", number(guess.position->first), number(guess.position->second),
                          guess.is_knee ? "   # guess: 0.1 to 2.6 rad from straight" : "   # guess");
    }
    if (guess.velocity)
      text += fmt::format("velocity_radps = {}   # guess: the URDF has none\n", number(*guess.velocity));
    if (guess.torque)
      text += fmt::format("torque_Nm = {}   # guess: five times the torque of standing; the URDF has none\n",
                          number(*guess.torque));
    if (guess.torque_is_no_limit) text += "# torque_Nm =      the URDF's 1000 N m or more is no limit\n";
    text += '\n';
  }
  return text;
}

}  // namespace

std::string robot_template(const NewRobot& robot, const std::string& urdf, const fs::path& file) {
  const std::string others = robot.search.other_ends.empty() ? std::string()
                                                             : fmt::format("\n# No contacts: the limbs that end in {}.",
                                                                           fmt::join(robot.search.other_ends, ", "));
  std::string text =
      fmt::format(fmt::runtime(kRobotHead), fmt::arg("name", robot.description.name), fmt::arg("mass", robot.mass),
                  fmt::arg("legs", robot.search.legs.size()), fmt::arg("file", one_line(file.string())),
                  fmt::arg("urdf", toml_string(urdf)), fmt::arg("others", others));
  if (!robot.description.locked_joints.empty()) {
    text += "# These move no mass by the URDF: no torque determines their motion.\nlocked_joints = [";
    for (const std::string& joint : robot.description.locked_joints)
      text += (text.ends_with('[') ? "" : ", ") + toml_string(joint);
    text += "]\n";
  }
  for (const std::string& mesh : robot.missing_meshes) text += fmt::format("# Unreadable mesh: {}\n", one_line(mesh));
  text += '\n';
  text += contacts(robot);
  text += armature(robot);
  text += posture(robot, file);
  text += limits(robot);
  while (text.ends_with("\n\n")) text.pop_back();
  return text;
}

std::string urdf_reference(const RobotDescription& robot, const fs::path& file, const PackageSearch& search) {
  const std::string scheme = "package://";
  std::set<std::string> packages;
  for (std::size_t at = 0; (at = robot.urdf_text.find(scheme, at)) != std::string::npos;) {
    at += scheme.size();
    packages.insert(robot.urdf_text.substr(at, robot.urdf_text.find_first_of("/\"'", at) - at));
  }
  for (fs::path folder = robot.urdf.parent_path(); folder.has_filename(); folder = folder.parent_path()) {
    if (!packages.contains(folder.filename().string())) continue;
    const std::string uri = scheme + folder.filename().string() + "/" + robot.urdf.lexically_relative(folder).string();
    try {
      std::error_code error;
      if (fs::equivalent(resolve_uri(uri, file, {}, search), robot.urdf, error) && !error) return uri;
    } catch (const InputError&) {  // not found from there: try a parent folder
    }
  }
  return robot.urdf.lexically_relative(fs::absolute(file).lexically_normal().parent_path()).string();
}

}  // namespace prowl

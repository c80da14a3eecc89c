#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "module_files.hpp"
#include "prowl/model/robot_inspection.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "screen/robot_summary.hpp"

namespace prowl::python {
namespace {

using Folders = std::vector<std::string>;

RobotModel read_robot(const std::filesystem::path& path, const Folders& package_dirs) {
  return load_robot(read_text_file(path), package_search(package_dirs), {.needs_contacts = false});
}

RobotModel parse_robot(const std::string& text, const std::filesystem::path& path, const Folders& package_dirs) {
  return load_robot({std::filesystem::absolute(path), text}, package_search(package_dirs), {.needs_contacts = false});
}

using Numbers = std::array<double, 3>;

std::vector<std::string> contact_names(const RobotModel& robot) {
  std::vector<std::string> names;
  for (const ContactPoint& contact : robot.contacts()) names.push_back(contact.name);
  return names;
}

std::vector<std::string> warnings(const RobotModel& robot) {
  std::vector<std::string> texts;
  for (const RobotWarning& warning : inspect(robot).warnings) texts.push_back(warning.text);
  return texts;
}

/// A property that is a read-only view of a vector of the robot.
template <const Eigen::VectorXd& (RobotModel::*vector)() const>
Vector robot_view(nb::handle self) {
  return view((nb::cast<const RobotModel&>(self).*vector)(), self);
}

}  // namespace

void bind_robot(nb::module_& module) {
  nb::class_<ContactPoint>(
      module, "Contact",
      "A place on the robot that may touch a surface: the centre of a ball fixed to a frame of the URDF.")
      .def_ro("name", &ContactPoint::name)
      .def_ro("frame", &ContactPoint::frame, "A link or a fixed joint of the URDF.")
      .def_ro("radius", &ContactPoint::radius, "[m]")
      .def_prop_ro(
          "offset", [](const ContactPoint& c) { return Numbers{c.offset.x(), c.offset.y(), c.offset.z()}; },
          "Of the centre from the frame's origin, in the frame [m].")
      .def("__repr__", [](const ContactPoint& c) { return fmt::format("<prowl.Contact {} at {}>", c.name, c.frame); });
  nb::class_<RobotModel>(
      module, "Robot",
      "A legged robot: rigid bodies on a floating base, and its limits. Immutable.\n\n"
      "Conventions are Pinocchio's. Configuration q, nq = 7 + nu: position of the base in the world [m], its\n"
      "quaternion x y z w, joint positions [rad or m]. Velocity v, nv = 6 + nu: linear and angular velocity of\n"
      "the base in the base frame [m/s, rad/s], joint rates. Torques tau: nu [N m].")
      .def_prop_ro("name", &RobotModel::name)
      .def_prop_ro("nq", &RobotModel::nq, "Numbers in q.")
      .def_prop_ro("nv", &RobotModel::nv, "Numbers in v.")
      .def_prop_ro("nu", &RobotModel::nu, "Joints, all of them with an actuator.")
      .def_prop_ro("mass", &RobotModel::mass, "[kg]")
      .def_prop_ro("joint_names", &RobotModel::joint_names, "nu names, in the order of q, v and tau.")
      .def_prop_ro("contacts", &RobotModel::contacts, nb::rv_policy::reference_internal)
      .def_prop_ro("contact_names", &contact_names, "In the order of contact forces.")
      .def_prop_ro(
          "urdf", [](const RobotModel& robot) { return robot.description().urdf; }, "Path of the URDF.")
      .def_prop_ro("nominal_configuration", &robot_view<&RobotModel::nominal_configuration>,
                   "Nominal posture on the ground: q (nq).")
      .def_prop_ro("position_lower", &robot_view<&RobotModel::position_lower>,
                   "(nu) [rad or m]; -inf where there is none.")
      .def_prop_ro("position_upper", &robot_view<&RobotModel::position_upper>,
                   "(nu) [rad or m]; inf where there is none.")
      .def_prop_ro("velocity_limit", &robot_view<&RobotModel::velocity_limit>,
                   "(nu) [rad/s or m/s]; inf where there is none.")
      .def_prop_ro("torque_limit", &robot_view<&RobotModel::torque_limit>,
                   "(nu) [N m or N]; inf where there is none. Joints may have further limits that depend on position "
                   "or velocity.")
      .def("warnings", &warnings, "What looks wrong with the robot, one sentence each.")
      .def("frames", &contact_frame_names, "Frames of the URDF that a contact may be fixed to.")
      .def(
          "summary", [](const RobotModel& robot) { return robot_summary(robot, inspect(robot)); },
          "What `prowl robot` prints: joints with limits, mass, contacts, warnings.")
      .def("__repr__", [](const RobotModel& robot) {
        return fmt::format("<prowl.Robot {}: {} joints, {} contacts, {:.3g} kg>", robot.name(), robot.nu(),
                           robot.contacts().size(), robot.mass());
      });
  module.def("read_robot", &read_robot, nb::arg("path"), nb::arg("package_dirs") = Folders{},
             "Reads a robot file, docs/robot-file.md.");
  module.def(
      "parse_robot", &parse_robot, nb::arg("text"), nb::arg("path"), nb::arg("package_dirs") = Folders{},
      "Reads the text of a robot file; paths in it are relative to the folder of `path`, where no file needs to be.");
}

}  // namespace prowl::python

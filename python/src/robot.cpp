#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "batch.hpp"
#include "bindings.hpp"
#include "module_files.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/model/robot_inspection.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/model/urdf/link_tree.hpp"
#include "prowl/task_file/reference_csv.hpp"
#include "prowl/task_file/robot_file.hpp"
#include "robot_source.hpp"
#include "screen/robot_summary.hpp"

namespace prowl::python {
namespace {

nb::object load(const SourceText& file, const Folders& package_dirs) {
  return with_source(nb::cast(load_robot(file, package_search(package_dirs), {.needs_contacts = false})), file);
}

nb::object read_robot(const std::filesystem::path& path, const Folders& package_dirs) {
  return load(read_text_file(path), package_dirs);
}

nb::object parse_robot(const std::string& text, const std::filesystem::path& path, const Folders& package_dirs) {
  return load({std::filesystem::absolute(path), text}, package_dirs);
}

/// Keys of the attributes that with_source() sets.
constexpr const char* kPath = "_path";
constexpr const char* kText = "_text";

using Point = std::array<double, 3>;

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

/// A link with the name of its parent instead of the index.
struct LinkView {
  std::string name;
  std::optional<std::string> parent;
  bool fixed = false;
};

std::vector<LinkView> links(const RobotModel& robot) {
  const std::vector<RobotLink> tree = link_tree(robot);
  std::vector<LinkView> views;
  for (const RobotLink& link : tree) {
    LinkView& view = views.emplace_back(LinkView{link.name, std::nullopt, link.fixed});
    if (link.parent >= 0) view.parent = tree[link.parent].name;
  }
  return views;
}

Array placements(const RobotModel& robot, const Argument& q_array, bool in_parent) {
  const Batch q(q_array, robot.nq(), "q");
  check_configurations(q, "q");
  const std::vector<RobotLink> tree = link_tree(robot);
  BodyPlacements bodies(robot);
  Results results(q, {tree.size(), 7});
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const std::vector<Eigen::Isometry3d> world = link_placements(tree, bodies.at(q.row(i)));
    RowMatrix rows(static_cast<Eigen::Index>(tree.size()), 7);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) {
      const int parent = in_parent ? tree[k].parent : -1;
      const Eigen::Isometry3d placement = parent < 0 ? world[k] : world[parent].inverse() * world[k];
      const Eigen::Quaterniond turn = Eigen::Quaterniond(placement.linear()).normalized();
      rows.row(k) << placement.translation().transpose(), turn.coeffs().transpose();
    }
    results.set(i, rows);
  }
  return std::move(results).array();
}

/// Times and postures of a reference.
std::pair<Array, Array> read_reference(const RobotModel& robot, const std::filesystem::path& path) {
  const ReferenceMotion reference = read_reference_csv(robot, read_text_file(path, kLongestReference));
  const auto rows = static_cast<std::size_t>(reference.times.size());
  return {new_array(reference.times), new_array({reference.q.reshaped().begin(), reference.q.reshaped().end()},
                                                {rows, static_cast<std::size_t>(robot.nq())})};
}

/// Invalid UTF-8 becomes U+FFFD.
nb::str urdf_text(const RobotModel& robot) {
  const std::string& text = robot.description().urdf_text;
  return nb::steal<nb::str>(PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "replace"));
}

/// Smallest and largest torques.
std::pair<Array, Array> torque_limits(const RobotModel& robot, const Argument& q_array, const Argument& v_array) {
  const Batch q(q_array, robot.nq(), "q"), v(v_array, robot.nv(), "v");
  check_same_rows(q, {{"v", &v}});
  const auto nu = static_cast<std::size_t>(robot.nu());
  Results lower(q, {nu}), upper(q, {nu});
  Eigen::VectorXd least(robot.nu()), greatest(robot.nu());
  for (Eigen::Index i = 0; i < q.rows(); ++i) {
    const Eigen::VectorXd positions = q.row(i).tail(robot.nu()), rates = v.row(i).tail(robot.nu());
    for (int j = 0; j < robot.nu(); ++j) {
      least(j) = robot.torque_lower(j, positions(j), rates(j));
      greatest(j) = robot.torque_upper(j, positions(j), rates(j));
    }
    lower.set(i, least);
    upper.set(i, greatest);
  }
  return {std::move(lower).array(), std::move(upper).array()};
}

/// Joints with a torque limit over position -> ends of its table.
nb::dict torque_over_position(const RobotModel& robot) {
  nb::dict ends;
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    if (limit.over_velocity) continue;
    ends[robot.joint_names()[limit.joint].c_str()] =
        nb::make_tuple(limit.positive.lower_end(), limit.positive.upper_end());
  }
  return ends;
}

/// A property: read-only view of a vector of the robot.
template <const Eigen::VectorXd& (RobotModel::*vector)() const>
Vector robot_view(nb::handle self) {
  return view((nb::cast<const RobotModel&>(self).*vector)(), self);
}

/// A property: read-only view of one kind of the losses.
template <Eigen::VectorXd JointLosses::* vector>
Vector losses_view(nb::handle self) {
  return view(nb::cast<const RobotModel&>(self).losses().*vector, self);
}

}  // namespace

nb::object with_source(nb::object robot, const SourceText& file) {
  nb::setattr(robot, kPath, nb::cast(std::filesystem::absolute(file.path)));
  nb::setattr(robot, kText, nb::str(file.text.data(), file.text.size()));
  return robot;
}

nb::object robot_of(nb::handle owner, const RobotModel& robot, const SourceText& file) {
  return with_source(nb::cast(robot, nb::rv_policy::reference_internal, owner), file);
}

void bind_robot(nb::module_& module) {
  nb::class_<ContactPoint>(
      module, "Contact",
      "A point of the robot that may touch a surface: centre of a ball fixed to a frame of the URDF.")
      .def_ro("name", &ContactPoint::name)
      .def_ro("frame", &ContactPoint::frame, "A link or a fixed joint of the URDF.")
      .def_ro("radius", &ContactPoint::radius, "[m]")
      .def_prop_ro(
          "offset", [](const ContactPoint& c) { return Point{c.offset.x(), c.offset.y(), c.offset.z()}; },
          "Centre of the ball in the frame [m].")
      .def("__repr__", [](const ContactPoint& c) { return fmt::format("<prowl.Contact {} at {}>", c.name, c.frame); });
  nb::class_<LinkView>(module, "Link", "A link of the URDF.")
      .def_ro("name", &LinkView::name)
      .def_ro("parent", &LinkView::parent, "Name of the parent link; None for the root.")
      .def_ro("fixed", &LinkView::fixed, "True if a fixed joint connects it to its parent.")
      .def("__repr__", [](const LinkView& link) { return fmt::format("<prowl.Link {}>", link.name); });
  nb::class_<RobotModel>(
      module, "Robot",
      "A legged robot: rigid bodies on a floating base, and its limits. Immutable.\n\n"
      "Conventions are Pinocchio's. Configuration q, nq = 7 + nu: position of the base in the world [m], its\n"
      "quaternion x y z w, joint positions [rad or m]. Velocity v, nv = 6 + nu: linear and angular velocity of\n"
      "the base in the base frame [m/s, rad/s], joint rates. Torques tau: nu [N m].",
      nb::dynamic_attr())
      .def_prop_ro("name", &RobotModel::name)
      .def_prop_ro("nq", &RobotModel::nq, "Size of q.")
      .def_prop_ro("nv", &RobotModel::nv, "Size of v.")
      .def_prop_ro("nu", &RobotModel::nu, "Number of joints, each with an actuator.")
      .def_prop_ro("mass", &RobotModel::mass, "[kg]")
      .def_prop_ro("joint_names", &RobotModel::joint_names, "nu names, in the order of q, v and tau.")
      .def_prop_ro("contacts", &RobotModel::contacts, nb::rv_policy::reference_internal)
      .def_prop_ro("contact_names", &contact_names, "Names in the order of contact forces.")
      .def_prop_ro(
          "path", [](nb::handle self) { return self.attr(kPath); }, nb::sig("def path(self) -> pathlib.Path"),
          "Path of the robot file.")
      .def_prop_ro(
          "text", [](nb::handle self) { return self.attr(kText); }, nb::sig("def text(self) -> str"),
          "Text of the robot file.")
      .def_prop_ro(
          "urdf", [](const RobotModel& robot) { return robot.description().urdf; }, "Path of the URDF.")
      .def_prop_ro("urdf_text", &urdf_text, "Text of the URDF.")
      .def_prop_ro("links", &links, "All links of the URDF: the root first, parents before children.")
      .def_prop_ro("nominal_configuration", &robot_view<&RobotModel::nominal_configuration>,
                   "Nominal posture on the ground: q (nq).")
      .def_prop_ro("position_lower", &robot_view<&RobotModel::position_lower>, "(nu) [rad or m]; -inf without limit.")
      .def_prop_ro("position_upper", &robot_view<&RobotModel::position_upper>, "(nu) [rad or m]; inf without limit.")
      .def_prop_ro("velocity_limit", &robot_view<&RobotModel::velocity_limit>,
                   "(nu) [rad/s or m/s]; inf without limit.")
      .def_prop_ro("torque_limit", &robot_view<&RobotModel::torque_limit>,
                   "(nu) [N m or N]; inf without limit. Joints may have further limits over position or velocity.")
      .def_prop_ro("damping", &losses_view<&JointLosses::damping>,
                   "Torque that the joints lose over their rates, as the URDF says: (nu) [N m s/rad or N s/m].")
      .def_prop_ro("dry_friction", &losses_view<&JointLosses::dry_friction>,
                   "The same while they move, whatever their rate: (nu) [N m or N].")
      .def_prop_ro("torque_over_position", &torque_over_position,
                   nb::sig("def torque_over_position(self) -> dict[str, tuple[float, float]]"),
                   "Joints with a torque limit over position: smallest and largest position of its table [rad].")
      .def("torque_limits", &torque_limits, nb::arg("q"), nb::arg("v"), nb::rv_policy::reference,
           "Smallest and largest torques of the joints in a state under all limits: two arrays (nu) [N m or N].\n"
           "One state, or N rows.")
      .def("link_placements", &placements, nb::arg("q"), nb::arg("in_parent") = false,
           "Placements of the links in the world, or in their parents (root: in the world), (links, 7): position [m],\n"
           "quaternion x y z w. One configuration, or N rows.")
      .def("read_reference", &read_reference, nb::arg("path"), nb::rv_policy::reference,
           "Times [s] and postures q (N, nq) of a CSV file for [reference] of a task, docs/retarget.md.")
      .def("warnings", &warnings, "Possible problems of the robot, one sentence each.")
      .def("frames", &contact_frame_names, "Frames of the URDF that may carry a contact.")
      .def(
          "summary", [](const RobotModel& robot) { return robot_summary(robot, inspect(robot)); },
          "Text that `prowl robot` prints: joints with limits, mass, contacts, warnings.")
      .def("__repr__", [](const RobotModel& robot) {
        return fmt::format("<prowl.Robot {}: {} joints, {} contacts, {:.3g} kg>", robot.name(), robot.nu(),
                           robot.contacts().size(), robot.mass());
      });
  module.def("read_robot", &read_robot, nb::arg("path"), nb::arg("package_dirs") = Folders{},
             nb::sig("def read_robot(path: str | os.PathLike, package_dirs: collections.abc.Sequence[str] = []) -> "
                     "Robot"),
             "Reads a robot file, docs/robot-file.md.");
  module.def(
      "parse_robot", &parse_robot, nb::arg("text"), nb::arg("path"), nb::arg("package_dirs") = Folders{},
      nb::sig("def parse_robot(text: str, path: str | os.PathLike, package_dirs: collections.abc.Sequence[str] = []) "
              "-> Robot"),
      "Reads the text of a robot file; paths in it are relative to the folder of `path`, which need not exist.");
}

}  // namespace prowl::python

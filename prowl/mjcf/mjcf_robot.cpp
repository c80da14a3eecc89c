#include "prowl/mjcf/mjcf_robot.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <tinyxml2.h>

#include <algorithm>

#include "prowl/mjcf/mjcf_model.hpp"

namespace prowl {

namespace fs = std::filesystem;

using Eigen::Isometry3d;
using Eigen::Matrix3d;
using Eigen::Vector3d;

namespace {

constexpr int kLastVisibleGroup = 2;  // geoms of higher groups are hidden in MuJoCo's viewer

std::string numbers(const Vector3d& v) { return fmt::format("{} {} {}", v.x(), v.y(), v.z()); }

/// Roll, pitch, yaw: R = Rz(yaw) Ry(pitch) Rx(roll).
Vector3d rpy(const Matrix3d& R) { return R.eulerAngles(2, 1, 0).reverse(); }

/// Writes the tree of bodies as links and joints.
class UrdfWriter {
 public:
  UrdfWriter(const MjcfModel& model, const fs::path& folder) : model_(model), folder_(folder) {}

  MjcfRobot write() {
    result_.name = model_.name();
    xml_.OpenElement("robot");
    xml_.PushAttribute("name", result_.name.c_str());
    xml_.PushAttribute("version", "1.2");  // the first with capsules
    add_link(model_.name_of(mjOBJ_BODY, model_.base()), model_.base(), Vector3d::Zero());
    for (const int child : model_.children(model_.base())) add_body(child, model_.base(), Vector3d::Zero());
    xml_.CloseElement();
    result_.urdf = xml_.CStr();
    add_notes();
    return std::move(result_);
  }

 private:
  /// The body, its joints and its descendants. A link's frame is its body's, moved to the place of the body's last
  /// joint: `offset` of the parent, in the body's axes.
  void add_body(int body, int parent, const Vector3d& parent_offset) {
    const std::string name = model_.name_of(mjOBJ_BODY, body);
    Isometry3d origin = placement_at(model_->body_pos, model_->body_quat, body);
    const Matrix3d rotation = origin.linear();
    std::string above = model_.name_of(mjOBJ_BODY, parent);
    const int count = model_->body_jntnum[body], first = model_->body_jntadr[body];
    if (count == 0) {
      origin.translation() -= parent_offset;
      add_joint(name + "_fixed", "fixed", above, name, origin);
      xml_.CloseElement();
    }
    Vector3d offset = Vector3d::Zero();
    for (int joint = first; joint < first + count; ++joint) {
      const Vector3d place = vector_at(model_->jnt_pos, joint);
      const bool is_first = joint == first, is_last = joint == first + count - 1;
      if (is_first)
        origin.translation() += rotation * place - parent_offset;
      else
        origin = Eigen::Translation3d(place - offset);
      const std::string joint_name = model_.name_of(mjOBJ_JOINT, joint), below = is_last ? name : joint_name + "_axis";
      add_moving_joint(joint, joint_name, above, below, origin);
      if (!is_last) add_massless_link(below);
      above = below;
      offset = place;
    }
    add_link(name, body, offset);
    for (const int child : model_.children(body)) add_body(child, body, offset);
  }

  /// Leaves the element open.
  void add_joint(const std::string& name, const char* type, const std::string& parent, const std::string& child,
                 const Isometry3d& origin) {
    xml_.OpenElement("joint");
    xml_.PushAttribute("name", name.c_str());
    xml_.PushAttribute("type", type);
    add_element("parent", {{"link", parent}});
    add_element("child", {{"link", child}});
    add_origin(origin);
  }

  void add_moving_joint(int joint, const std::string& name, const std::string& parent, const std::string& child,
                        const Isometry3d& origin) {
    add_joint(name, model_->jnt_type[joint] == mjJNT_SLIDE ? "prismatic" : "revolute", parent, child, origin);
    add_element("axis", {{"xyz", numbers(vector_at(model_->jnt_axis, joint))}});
    const double zero = model_->qpos0[model_->jnt_qposadr[joint]];  // MuJoCo's position where the URDF's is 0
    const bool is_limited = model_->jnt_limited[joint];
    add_element("limit", {{"lower", is_limited ? fmt::to_string(model_->jnt_range[2 * joint] - zero) : "0"},
                          {"upper", is_limited ? fmt::to_string(model_->jnt_range[2 * joint + 1] - zero) : "0"},
                          {"effort", fmt::to_string(model_.torque_limit(joint).value_or(0.0))},
                          {"velocity", "0"}});
    add_mimic(joint);
    const int degree = model_->jnt_dofadr[joint];
    const double damping = model_->dof_damping[degree], friction = model_->dof_frictionloss[degree];
    if (damping > 0.0 || friction > 0.0)
      add_element("dynamics", {{"damping", fmt::to_string(damping)}, {"friction", fmt::to_string(friction)}});
    xml_.CloseElement();
    if (model_->dof_armature[degree] > 0.0) result_.armature[name] = model_->dof_armature[degree];
    if (zero != 0.0) moved_zeros_.push_back(name);
    if (model_.actuators(joint).empty()) passive_.push_back(name);
    if (model_->jnt_stiffness[joint] > 0.0) ++sprung_;
  }

  /// A joint that an equality constraint couples to another.
  void add_mimic(int joint) {
    for (int i = 0; i < model_->neq; ++i) {
      if (model_->eq_type[i] != mjEQ_JOINT || model_->eq_obj1id[i] != joint || model_->eq_obj2id[i] < 0) continue;
      add_element("mimic", {{"joint", model_.name_of(mjOBJ_JOINT, model_->eq_obj2id[i])},
                            {"offset", fmt::to_string(model_->eq_data[mjNEQDATA * i])},
                            {"multiplier", fmt::to_string(model_->eq_data[mjNEQDATA * i + 1])}});
      return;
    }
  }

  void add_massless_link(const std::string& name) { add_element("link", {{"name", name}}); }

  void add_link(const std::string& name, int body, const Vector3d& offset) {
    xml_.OpenElement("link");
    xml_.PushAttribute("name", name.c_str());
    if (model_->body_mass[body] > 0.0) {
      const Matrix3d axes = rotation_at(model_->body_iquat, body);
      const Matrix3d inertia = axes * vector_at(model_->body_inertia, body).asDiagonal() * axes.transpose();
      Isometry3d center = Isometry3d::Identity();
      center.translation() = vector_at(model_->body_ipos, body) - offset;
      xml_.OpenElement("inertial");
      add_origin(center);
      add_element("mass", {{"value", fmt::to_string(model_->body_mass[body])}});
      add_element("inertia", {{"ixx", fmt::to_string(inertia(0, 0))},
                              {"iyy", fmt::to_string(inertia(1, 1))},
                              {"izz", fmt::to_string(inertia(2, 2))},
                              {"ixy", fmt::to_string(inertia(0, 1))},
                              {"ixz", fmt::to_string(inertia(0, 2))},
                              {"iyz", fmt::to_string(inertia(1, 2))}});
      xml_.CloseElement();
    }
    for (int i = 0; i < model_->body_geomnum[body]; ++i) add_geom(model_->body_geomadr[body] + i, offset);
    xml_.CloseElement();
  }

  void add_geom(int geom, const Vector3d& offset) {
    Isometry3d placement = placement_at(model_->geom_pos, model_->geom_quat, geom);
    placement.translation() -= offset;
    const bool collides = model_->geom_contype[geom] != 0 || model_->geom_conaffinity[geom] != 0;
    if (model_->geom_group[geom] <= kLastVisibleGroup) add_shapes("visual", geom, placement);
    if (collides) add_shapes("collision", geom, placement);
  }

  /// A shape that a URDF does not have becomes its bounding box.
  void add_shapes(const char* use, int geom, const Isometry3d& placement) {
    const Vector3d size = vector_at(model_->geom_size, geom);
    const auto add = [&](const Isometry3d& at, const char* shape, const Attributes& attributes) {
      xml_.OpenElement(use);
      add_origin(at);
      xml_.OpenElement("geometry");
      add_element(shape, attributes);
      xml_.CloseElement();
      xml_.CloseElement();
    };
    const std::string radius = fmt::to_string(size.x()), length = fmt::to_string(2.0 * size.y());
    const int type = model_->geom_type[geom], mesh = model_->geom_dataid[geom];
    if (type == mjGEOM_PLANE || type == mjGEOM_HFIELD) return;  // of the world, without a volume
    if (type == mjGEOM_SPHERE) return add(placement, "sphere", {{"radius", radius}});
    if (type == mjGEOM_BOX) return add(placement, "box", {{"size", numbers(2.0 * size)}});
    if (type == mjGEOM_CYLINDER) return add(placement, "cylinder", {{"radius", radius}, {"length", length}});
    if (type == mjGEOM_CAPSULE) return add(placement, "capsule", {{"radius", radius}, {"length", length}});
    if (const fs::path file = type == mjGEOM_MESH ? model_.mesh_file(mesh) : fs::path(); !file.empty()) {
      // MuJoCo moves the vertices to the mesh's principal axes, and its geom with them.
      const Isometry3d moved = placement_at(model_->mesh_pos, model_->mesh_quat, mesh);
      return add(placement * moved.inverse(), "mesh",
                 {{"filename", file.lexically_relative(folder_).generic_string()},
                  {"scale", numbers(vector_at(model_->mesh_scale, mesh))}});
    }
    const Vector3d centre = vector_at(model_->geom_aabb, 2 * geom), half = vector_at(model_->geom_aabb, 2 * geom + 1);
    add(placement * Eigen::Translation3d(centre), "box", {{"size", numbers(2.0 * half)}});
  }

  void add_origin(const Isometry3d& at) {
    add_element("origin", {{"xyz", numbers(at.translation())}, {"rpy", numbers(rpy(at.linear()))}});
  }

  using Attributes = std::vector<std::pair<const char*, std::string>>;
  void add_element(const char* name, const Attributes& attributes) {
    xml_.OpenElement(name);
    for (const auto& [key, value] : attributes) xml_.PushAttribute(key, value.c_str());
    xml_.CloseElement();
  }

  void add_notes() {
    const auto add = [&](const std::vector<std::string>& joints, const char* what) {
      if (!joints.empty()) result_.notes.push_back(fmt::format("{}: {}", what, fmt::join(joints, ", ")));
    };
    add(moved_zeros_, "joints whose position 0 is their `ref` in the MJCF");
    add(passive_, "joints without an actuator, which Prowl moves by torques; see locked_joints");
    if (sprung_ > 0) result_.notes.push_back(fmt::format("springs of {} joints are left out", sprung_));
  }

  const MjcfModel& model_;
  const fs::path& folder_;
  MjcfRobot result_;
  std::vector<std::string> moved_zeros_, passive_;
  int sprung_ = 0;
  tinyxml2::XMLPrinter xml_;
};

}  // namespace

bool is_mjcf(const std::string& xml) {
  tinyxml2::XMLDocument document;
  if (document.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS) return false;
  const tinyxml2::XMLElement* const root = document.RootElement();
  return root && std::string_view(root->Name()) == "mujoco";
}

MjcfRobot read_mjcf(const fs::path& file, const fs::path& folder) {
  const MjcfModel model(file);
  return UrdfWriter(model, folder).write();
}

}  // namespace prowl

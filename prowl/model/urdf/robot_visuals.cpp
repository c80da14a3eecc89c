#include "prowl/model/urdf/robot_visuals.hpp"

#include <urdf_parser/urdf_parser.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/model/pinocchio_model.hpp"

namespace prowl {
namespace {

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  const urdf::Rotation& r = pose.rotation;
  Eigen::Isometry3d placement = Eigen::Isometry3d::Identity();
  placement.linear() = Eigen::Quaterniond(r.w, r.x, r.y, r.z).normalized().toRotationMatrix();
  placement.translation() = Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z);
  return placement;
}

void set_shape(const urdf::Geometry& geometry, RobotVisual& visual) {
  using Shape = RobotVisual::Kind;
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const auto& box = static_cast<const urdf::Box&>(geometry);
      visual.kind = Shape::box;
      visual.size = {box.dim.x, box.dim.y, box.dim.z};
      return;
    }
    case urdf::Geometry::SPHERE:
      visual.kind = Shape::sphere;
      visual.size.setConstant(static_cast<const urdf::Sphere&>(geometry).radius);
      return;
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      visual.kind = Shape::cylinder;
      visual.size = {cylinder.radius, cylinder.radius, cylinder.length};
      return;
    }
    case urdf::Geometry::CAPSULE: {
      const auto& capsule = static_cast<const urdf::Capsule&>(geometry);
      visual.kind = Shape::capsule;
      visual.size = {capsule.radius, capsule.radius, capsule.length};
      return;
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = static_cast<const urdf::Mesh&>(geometry);
      visual.kind = Shape::mesh;
      visual.size = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
      visual.mesh = mesh.filename;
      return;
    }
  }
}

std::optional<Eigen::Vector3d> colour_of(const urdf::Visual& visual) {
  if (!visual.material) return std::nullopt;
  const urdf::Color& colour = visual.material->color;
  const Eigen::Vector3d rgb(colour.r, colour.g, colour.b);
  // urdfdom sets colour and opacity of a material with a texture only to zero.
  if (!rgb.allFinite() || (rgb.isZero() && !(colour.a > 0.0f))) return std::nullopt;
  return rgb.cwiseMax(0.0).cwiseMin(1.0);
}

template <class Sources, class Colour>
std::vector<RobotVisual> shapes_of(const RobotModel& robot, const Sources& sources, const Colour& colour) {
  const pinocchio::Model& model = robot.pinocchio().model;
  const urdf::ModelInterfaceSharedPtr urdf = urdf::parseURDF(robot.description().urdf_text);
  if (!urdf) throw InputError(robot.description().urdf.string() + ": urdfdom cannot read it");
  std::vector<RobotVisual> visuals;
  for (const auto& [name, link] : urdf->links_) {
    if (!model.existFrame(name, pinocchio::BODY)) continue;
    const pinocchio::Frame& frame = model.frames[model.getFrameId(name, pinocchio::BODY)];
    if (frame.parentJoint < kBaseJoint) continue;
    Eigen::Isometry3d in_body = Eigen::Isometry3d::Identity();
    in_body.linear() = frame.placement.rotation();
    in_body.translation() = frame.placement.translation();
    for (const auto& source : sources(*link)) {
      if (!source || !source->geometry) continue;
      RobotVisual& visual = visuals.emplace_back();
      visual.link = name;
      visual.body = static_cast<int>(frame.parentJoint - kBaseJoint);
      visual.placement = in_body * to_isometry(source->origin);
      visual.colour = colour(*source);
      set_shape(*source->geometry, visual);
    }
  }
  return visuals;
}

}  // namespace

std::vector<RobotVisual> robot_visuals(const RobotModel& robot) {
  return shapes_of(
      robot, [](const urdf::Link& link) { return link.visual_array; },
      [](const urdf::Visual& source) { return colour_of(source); });
}

std::vector<RobotVisual> robot_collisions(const RobotModel& robot) {
  return shapes_of(
      robot, [](const urdf::Link& link) { return link.collision_array; },
      [](const urdf::Collision&) { return std::optional<Eigen::Vector3d>(); });
}

std::optional<RobotVisual> inertia_box(const BodyTree& tree, int index) {
  const RigidBody& body = tree.bodies[index];
  if (!(body.mass > 0.0)) return std::nullopt;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes(body.inertia);
  const Eigen::Vector3d& moment = axes.eigenvalues();
  RobotVisual box;
  box.link = body.name;
  box.body = index;
  box.placement.linear() = axes.eigenvectors();
  if (box.placement.linear().determinant() < 0.0) box.placement.linear().col(0) *= -1.0;
  box.placement.translation() = body.center;
  // I_x = m (b^2 + c^2) / 12, and so on: a^2 = 6 (I_y + I_z - I_x) / m
  for (int i = 0; i < 3; ++i) {
    box.size(i) = std::sqrt(std::max(0.0, 6.0 * (moment.sum() - 2.0 * moment(i)) / body.mass));
  }
  return box;
}

}  // namespace prowl

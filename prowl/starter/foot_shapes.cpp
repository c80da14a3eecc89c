#include "prowl/starter/foot_shapes.hpp"

#include <cmath>
#include <filesystem>
#include <numbers>

#include "prowl/error.hpp"
#include "prowl/files/visual_mesh.hpp"
#include "prowl/model/urdf/robot_visuals.hpp"

namespace prowl {
namespace {

constexpr int kCircle = 48;  // points of a circle; its chords are within 0.2 % of the radius

Eigen::Matrix3Xd box_points(const Eigen::Vector3d& size) {
  Eigen::Matrix3Xd points(3, 8);
  for (int i = 0; i < 8; ++i) {
    points.col(i) = 0.5 * Eigen::Vector3d((i & 1) != 0 ? size.x() : -size.x(), (i & 2) != 0 ? size.y() : -size.y(),
                                          (i & 4) != 0 ? size.z() : -size.z());
  }
  return points;
}

/// Points of circles (radius, height) about z [m].
Eigen::Matrix3Xd circle_points(const std::vector<std::pair<double, double>>& circles) {
  Eigen::Matrix3Xd points(3, kCircle * static_cast<int>(circles.size()));
  int column = 0;
  for (const auto& [radius, height] : circles) {
    for (int i = 0; i < kCircle; ++i, ++column) {
      const double angle = 2.0 * std::numbers::pi * i / kCircle;
      points.col(column) = Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), height);
    }
  }
  return points;
}

Eigen::Matrix3Xd capsule_points(double radius, double length) {
  std::vector<std::pair<double, double>> circles;
  constexpr int kRings = 12;
  for (int i = 0; i <= kRings; ++i) {
    const double angle = 0.5 * std::numbers::pi * i / kRings;
    circles.emplace_back(radius * std::cos(angle), 0.5 * length + radius * std::sin(angle));
    circles.emplace_back(radius * std::cos(angle), -0.5 * length - radius * std::sin(angle));
  }
  return circle_points(circles);
}

Eigen::Matrix3Xd mesh_points(const RobotVisual& shape, const RobotModel& robot, const PackageSearch& search) {
  std::vector<Eigen::Vector3d> points;
  for (const VisualMesh& mesh : read_visual_mesh(resolve_uri(shape.mesh, robot.description().urdf, {}, search))) {
    for (std::size_t i = 0; i < mesh.num_vertices(); ++i) {
      const float* p = &mesh.positions[3 * i];
      points.emplace_back(shape.size.cwiseProduct(Eigen::Vector3d(p[0], p[1], p[2])));
    }
  }
  Eigen::Matrix3Xd matrix(3, static_cast<Eigen::Index>(points.size()));
  for (std::size_t i = 0; i < points.size(); ++i) matrix.col(static_cast<Eigen::Index>(i)) = points[i];
  return matrix;
}

FootShape to_foot_shape(const RobotVisual& shape, const RobotModel& robot, const PackageSearch& search) {
  using Kind = RobotVisual::Kind;
  FootShape result{.link = shape.link, .kind = {}, .points = {}};
  result.rolls = shape.kind != Kind::box && shape.kind != Kind::mesh;
  switch (shape.kind) {
    case Kind::sphere:
      result.kind = "sphere";
      result.radius = shape.size.x();
      result.points = Eigen::Vector3d::Zero();
      break;
    case Kind::box:
      result.kind = "box";
      result.points = box_points(shape.size);
      break;
    case Kind::cylinder:
      result.kind = "cylinder";
      result.points = circle_points({{shape.size.x(), 0.5 * shape.size.z()}, {shape.size.x(), -0.5 * shape.size.z()}});
      break;
    case Kind::capsule:
      result.kind = "capsule";
      result.points = capsule_points(shape.size.x(), shape.size.z());
      break;
    case Kind::mesh:
      result.kind = "mesh " + std::filesystem::path(shape.mesh).filename().string();
      result.points = mesh_points(shape, robot, search);
      break;
  }
  result.points = ((shape.placement.linear() * result.points).colwise() + shape.placement.translation()).eval();
  return result;
}

void add_shapes(const std::vector<RobotVisual>& shapes, int body, const RobotModel& robot, const PackageSearch& search,
                FootShapes& result) {
  for (const RobotVisual& shape : shapes) {
    if (shape.body != body) continue;
    try {
      result.shapes.push_back(to_foot_shape(shape, robot, search));
    } catch (const Error& error) {
      const std::string message = error.what();
      result.missing.push_back(message.substr(0, message.find('\n')));
    }
  }
}

}  // namespace

std::vector<FootShapes> foot_shapes(const RobotModel& robot, const std::vector<int>& bodies,
                                    const PackageSearch& search) {
  const std::vector<RobotVisual> collisions = robot_collisions(robot), visuals = robot_visuals(robot);
  std::vector<FootShapes> result;
  for (const int body : bodies) {
    FootShapes& foot = result.emplace_back();
    add_shapes(collisions, body, robot, search, foot);
    if (!foot.shapes.empty()) continue;
    foot.are_visual = true;
    add_shapes(visuals, body, robot, search, foot);
  }
  return result;
}

}  // namespace prowl

#include <map>

#include "prowl/files/base64.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/plan_folder/robot_look.hpp"
#include "prowl/report_page/report_json.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Eigen::Vector3d& v) { return {v.x(), v.y(), v.z()}; }

Json to_json(const Eigen::Isometry3d& placement) {
  const Eigen::Vector3d p = placement.translation();
  const Eigen::Quaterniond q = Eigen::Quaterniond(placement.linear()).normalized();
  return {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()};
}

const char* to_text(RobotVisual::Kind kind) {
  switch (kind) {
    case RobotVisual::Kind::box: return "box";
    case RobotVisual::Kind::sphere: return "sphere";
    case RobotVisual::Kind::cylinder: return "cylinder";
    case RobotVisual::Kind::capsule: return "capsule";
    case RobotVisual::Kind::mesh: return "mesh";
  }
  return "box";
}

/// Writes the meshes, and their indices by URI.
Json meshes_json(const RobotLook& look, std::map<std::string, Json>& indices) {
  Json meshes = Json::array();
  for (const auto& [uri, parts] : look.meshes) {
    for (const VisualMesh& part : parts) {
      indices[uri].push_back(meshes.size());
      Json colour = nullptr;
      if (part.colour) colour = to_json(*part.colour);
      meshes.push_back(
          {{"positions", base64(part.positions)}, {"triangles", base64(part.triangles)}, {"colour", colour}});
    }
  }
  return meshes;
}

/// Centre of mass of bodies at their placements in the world [m].
Eigen::Vector3d mass_centre(const BodyTree& tree, const std::vector<Eigen::Isometry3d>& placements) {
  double mass = 0.0;
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    mass += tree.bodies[b].mass;
    moment += tree.bodies[b].mass * (placements[b] * tree.bodies[b].center);
  }
  return moment / mass;
}

Json surfaces_json(const std::vector<Surface>& all) {
  Json surfaces = Json::array();
  for (const Surface& surface : all) {
    Json patch = Json::array();
    for (const Eigen::Vector2d& corner : surface.patch) patch.push_back(to_json(surface.at(corner)));
    surfaces.push_back({{"name", surface.name},
                        {"point", to_json(surface.point)},
                        {"normal", to_json(surface.normal)},
                        {"friction", surface.friction},
                        {"patch", patch}});
  }
  return surfaces;
}

}  // namespace

Json report_scene(const RobotModel& robot, const std::vector<Surface>& surfaces, const PackageSearch& search,
                  std::vector<std::string>& warnings) {
  const BodyTree tree = body_tree(robot);
  const RobotLook look = robot_look(robot, search, warnings);
  std::map<std::string, Json> indices;
  Json json = {{"meshes", meshes_json(look, indices)},
               {"visuals", Json::array()},
               {"bodies", Json::array()},
               {"contacts", Json::array()}};
  for (const RobotVisual& visual : look.visuals) {
    Json colour = nullptr, parts = Json::array();
    if (visual.colour) colour = to_json(*visual.colour);
    if (visual.kind == RobotVisual::Kind::mesh) parts = indices.at(visual.mesh);
    json["visuals"].push_back({{"link", visual.link},
                               {"body", visual.body},
                               {"placement", to_json(visual.placement)},
                               {"kind", to_text(visual.kind)},
                               {"size", to_json(visual.size)},
                               {"meshes", parts},
                               {"colour", colour}});
  }
  for (const RigidBody& body : tree.bodies) json["bodies"].push_back(body.name);
  for (std::size_t c = 0; c < tree.points.size(); ++c) {
    const ContactPoint& contact = robot.contacts()[c];
    json["contacts"].push_back({{"name", contact.name},
                                {"body", tree.points[c].body},
                                {"point", to_json(tree.points[c].position)},
                                {"radius", contact.radius}});
  }
  json["surfaces"] = surfaces_json(surfaces);
  return json;
}

Json report_motion_json(const RobotModel& robot, const std::vector<TrajectoryPoint>& points) {
  const BodyTree tree = body_tree(robot);
  BodyPlacements bodies(robot);
  Json times = Json::array();
  std::vector<float> placements, forces, mass_centres;
  for (const TrajectoryPoint& point : points) {
    times.push_back(point.time);
    const std::vector<Eigen::Isometry3d>& placed = bodies.at(point.q);
    const Eigen::Vector3f centre = mass_centre(tree, placed).cast<float>();
    mass_centres.insert(mass_centres.end(), {centre.x(), centre.y(), centre.z()});
    for (const Eigen::Isometry3d& placement : placed) {
      const Eigen::Quaternionf q = Eigen::Quaterniond(placement.linear()).normalized().cast<float>();
      const Eigen::Vector3f p = placement.translation().cast<float>();
      placements.insert(placements.end(), {p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w()});
    }
    for (const double f : point.force) forces.push_back(static_cast<float>(f));
  }
  return {{"time", times},
          {"placements", base64(placements)},
          {"forces", base64(forces)},
          {"mass_centre", base64(mass_centres)}};
}

}  // namespace prowl

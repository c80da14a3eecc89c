#include <fmt/format.h>

#include <map>
#include <set>

#include "prowl/error.hpp"
#include "prowl/files/base64.hpp"
#include "prowl/files/visual_mesh.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/model/urdf/robot_visuals.hpp"
#include "prowl/report_page/report_json.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kMostTriangles = 40000;  ///< of all meshes of a robot together: about 1 MB of the report

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

/// Mesh files of the visuals, each read once, reduced to a common budget of triangles.
class Meshes {
 public:
  Meshes(const RobotModel& robot, const PackageSearch& search) : urdf_(robot.description().urdf), search_(search) {}

  /// Throws InputError if the file cannot be found or read.
  void read(const std::string& uri) {
    if (parts_.contains(uri)) return;
    parts_[uri] = read_visual_mesh(resolve_uri(uri, urdf_, {}, search_));
  }

  /// All meshes as JSON; sets the mesh indices of each URI.
  Json take() {
    double triangles = 0.0;
    for (const auto& [uri, parts] : parts_) {
      for (const VisualMesh& part : parts) triangles += static_cast<double>(part.num_triangles());
    }
    Json meshes = Json::array();
    for (auto& [uri, parts] : parts_) {
      for (VisualMesh& part : parts) {
        simplify(part, kMostTriangles / triangles);
        indices_[uri].push_back(meshes.size());
        Json colour = nullptr;
        if (part.colour) colour = to_json(*part.colour);
        meshes.push_back(
            {{"positions", base64(part.positions)}, {"triangles", base64(part.triangles)}, {"colour", colour}});
      }
    }
    return meshes;
  }

  Json indices(const std::string& uri) const { return indices_.at(uri); }

 private:
  const std::filesystem::path& urdf_;
  const PackageSearch& search_;
  std::map<std::string, std::vector<VisualMesh>> parts_;
  std::map<std::string, std::vector<std::size_t>> indices_;
};

/// The robot's visuals with readable meshes; a body that loses one gets a box of its inertia.
std::vector<RobotVisual> readable_visuals(const RobotModel& robot, const BodyTree& tree, Meshes& meshes,
                                          std::vector<std::string>& warnings) {
  std::vector<RobotVisual> visuals;
  std::set<int> incomplete;
  std::set<std::string> unreadable;
  for (const RobotVisual& visual : robot_visuals(robot)) {
    try {
      if (visual.kind == RobotVisual::Kind::mesh) meshes.read(visual.mesh);
      visuals.push_back(visual);
    } catch (const InputError& error) {
      if (unreadable.insert(visual.mesh).second) {
        warnings.push_back(fmt::format("link {}: drawn as a box of its inertia: {}", visual.link, error.what()));
      }
      incomplete.insert(visual.body);
    }
  }
  if (visuals.empty() && incomplete.empty()) {
    warnings.push_back(fmt::format("{}: contains no <visual>: bodies are drawn as boxes of their inertia",
                                   robot.description().urdf.string()));
    for (std::size_t b = 0; b < tree.bodies.size(); ++b) incomplete.insert(static_cast<int>(b));
  }
  for (const int body : incomplete) {
    if (const auto box = inertia_box(tree, body)) visuals.push_back(*box);
  }
  return visuals;
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

Json surfaces_json(const MotionProblem& problem) {
  Json surfaces = Json::array();
  for (const Surface& surface : problem.surfaces) {
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

Json report_scene(const MotionProblem& problem, const PackageSearch& search, std::vector<std::string>& warnings) {
  const RobotModel& robot = problem.robot;
  const BodyTree tree = body_tree(robot);
  Meshes meshes(robot, search);
  const std::vector<RobotVisual> visuals = readable_visuals(robot, tree, meshes, warnings);
  Json json = {
      {"meshes", meshes.take()}, {"visuals", Json::array()}, {"bodies", Json::array()}, {"contacts", Json::array()}};
  for (const RobotVisual& visual : visuals) {
    Json colour = nullptr, parts = Json::array();
    if (visual.colour) colour = to_json(*visual.colour);
    if (visual.kind == RobotVisual::Kind::mesh) parts = meshes.indices(visual.mesh);
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
  json["surfaces"] = surfaces_json(problem);
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

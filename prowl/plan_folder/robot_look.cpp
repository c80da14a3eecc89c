#include "prowl/plan_folder/robot_look.hpp"

#include <fmt/format.h>

#include <set>

#include "prowl/error.hpp"
#include "prowl/model/body_tree.hpp"

namespace prowl {
namespace {

constexpr double kMostTriangles = 40000;  ///< of all meshes of a robot together: about 1 MB of a file

void simplify_all(RobotLook& look) {
  double triangles = 0.0;
  for (const auto& [uri, parts] : look.meshes) {
    for (const VisualMesh& part : parts) triangles += static_cast<double>(part.num_triangles());
  }
  for (auto& [uri, parts] : look.meshes) {
    for (VisualMesh& part : parts) simplify(part, kMostTriangles / triangles);
  }
}

}  // namespace

RobotLook robot_look(const RobotModel& robot, const PackageSearch& search, std::vector<std::string>& warnings) {
  const std::filesystem::path& urdf = robot.description().urdf;
  const BodyTree tree = body_tree(robot);
  RobotLook look;
  std::set<int> incomplete;
  std::set<std::string> unreadable;
  for (const RobotVisual& visual : robot_visuals(robot)) {
    try {
      if (visual.kind == RobotVisual::Kind::mesh && !look.meshes.contains(visual.mesh)) {
        look.meshes[visual.mesh] = read_visual_mesh(resolve_uri(visual.mesh, urdf, {}, search));
      }
      look.visuals.push_back(visual);
    } catch (const InputError& error) {
      if (unreadable.insert(visual.mesh).second) {
        warnings.push_back(fmt::format("link {}: drawn as a box of its inertia: {}", visual.link, error.what()));
      }
      incomplete.insert(visual.body);
    }
  }
  if (look.visuals.empty() && incomplete.empty()) {
    warnings.push_back(
        fmt::format("{}: contains no <visual>: bodies are drawn as boxes of their inertia", urdf.string()));
    for (std::size_t b = 0; b < tree.bodies.size(); ++b) incomplete.insert(static_cast<int>(b));
  }
  for (const int body : incomplete) {
    if (const auto box = inertia_box(tree, body)) look.visuals.push_back(*box);
  }
  simplify_all(look);
  return look;
}

}  // namespace prowl

#include "prowl/simulation/collision_shapes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "prowl/error.hpp"
#include "prowl/files/visual_mesh.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/simulation/mujoco_model.hpp"
#include "prowl/simulation/mujoco_state.hpp"

namespace prowl {
namespace {

constexpr int kMostVertices = 64;  ///< of a hull: within millimetres, and fast

/// Vertices of the convex hull, by MuJoCo.
std::vector<float> hull_of(const std::vector<float>& points) {
  const MujocoSpec spec(mj_makeSpec());
  mjsMesh* const mesh = mjs_addMesh(spec.get(), nullptr);
  mjs_setName(mesh->element, "mesh");
  mesh->inertia = mjMESH_INERTIA_CONVEX;  // of a mesh that need not be closed
  mesh->maxhullvert = kMostVertices;
  mjs_setFloat(mesh->uservert, points.data(), static_cast<int>(points.size()));
  mjsGeom* const geom = mjs_addGeom(mjs_findBody(spec.get(), "world"), nullptr);
  geom->type = mjGEOM_MESH;
  mjs_setString(geom->meshname, "mesh");
  const auto model = compile(spec.get());
  if (!model) throw InputError(mjs_getError(spec.get()));
  const int* const graph = model->mesh_graph + model->mesh_graphadr[0];
  const int count = graph[0];
  const int* const ids = graph + 2 + count;  // of the vertices of the hull
  // MuJoCo moves a mesh to its centre of mass and axes of inertia.
  const Eigen::Map<const Eigen::Vector3d> centre(model->mesh_pos);
  const double* const q = model->mesh_quat;
  const Eigen::Quaterniond turn(q[0], q[1], q[2], q[3]);
  std::vector<float> hull;
  for (int i = 0; i < count; ++i) {
    const Eigen::Map<const Eigen::Vector3f> vertex(model->mesh_vert + 3 * ids[i]);
    const Eigen::Vector3f point = (turn * vertex.cast<double>() + centre).cast<float>();
    hull.insert(hull.end(), point.begin(), point.end());
  }
  return hull;
}

/// All parts of a mesh file, with the factors of the URDF.
std::vector<float> scaled_points(const RobotVisual& mesh, const std::filesystem::path& file) {
  std::vector<float> points;
  for (const VisualMesh& part : read_visual_mesh(file)) {
    for (std::size_t i = 0; i + 2 < part.positions.size(); i += 3) {
      for (int axis = 0; axis < 3; ++axis)
        points.push_back(part.positions[i + static_cast<std::size_t>(axis)] * static_cast<float>(mesh.size(axis)));
    }
  }
  return points;
}

/// Leaves out what overlaps in the nominal posture, which stands on z = 0.
void leave_out_overlaps(const RobotModel& robot, CollisionShapes& all) {
  PhysicsOptions options;
  options.collisions = std::make_shared<const CollisionShapes>(all);
  const MujocoModel built = make_mujoco_model(robot, {Surface{}}, options);
  const mjModel* const model = built.model.get();
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model), &mj_deleteData);
  const Eigen::VectorXd qpos = mujoco_qpos(robot.nominal_configuration());
  std::copy(qpos.begin(), qpos.end(), data->qpos);
  mj_forward(model, data.get());
  const BodyTree tree = body_tree(robot);
  std::set<std::pair<int, int>> apart;
  std::set<std::size_t> grounded;
  for (int i = 0; i < data->ncon; ++i) {
    const mjContact& touch = data->contact[i];
    const auto g0 = static_cast<std::size_t>(touch.geom[0]), g1 = static_cast<std::size_t>(touch.geom[1]);
    const bool with_ground = built.surface_of_geom[g0] >= 0 || built.surface_of_geom[g1] >= 0;
    const int shape = std::max(built.shape_of_geom[g0], built.shape_of_geom[g1]);
    if (shape < 0) continue;  // a contact on the ground
    if (with_ground) {
      grounded.insert(static_cast<std::size_t>(shape));
      continue;
    }
    const int b0 = model->geom_bodyid[g0] - built.base_body, b1 = model->geom_bodyid[g1] - built.base_body;
    apart.insert(std::minmax(b0, b1));
  }
  for (const auto& [one, other] : apart) {
    all.apart.emplace_back(one, other);
    all.left_out.push_back(fmt::format("{} and {} overlap in the nominal posture",
                                       tree.bodies[static_cast<std::size_t>(one)].name,
                                       tree.bodies[static_cast<std::size_t>(other)].name));
  }
  for (const std::size_t shape : grounded) {
    all.shapes[shape].misses_ground = true;
    all.left_out.push_back(fmt::format("{} is in the ground in the nominal posture", all.shapes[shape].shape.link));
  }
}

}  // namespace

std::shared_ptr<const CollisionShapes> collision_shapes(const RobotModel& robot, const PackageSearch& search) {
  CollisionShapes all;
  std::set<std::string> of_contacts;
  for (const ContactPoint& contact : robot.contacts()) of_contacts.insert(contact.frame);
  for (RobotVisual& shape : robot_collisions(robot)) {
    if (of_contacts.contains(shape.link)) continue;
    CollisionShape one{std::move(shape), {}, false};
    if (one.shape.kind == RobotVisual::Kind::mesh) {
      try {
        one.hull = hull_of(scaled_points(one.shape, resolve_uri(one.shape.mesh, robot.description().urdf, {}, search)));
      } catch (const InputError& error) {
        all.unreadable.push_back(fmt::format("{}: {}", one.shape.link, error.what()));
        continue;
      }
    }
    all.shapes.push_back(std::move(one));
  }
  leave_out_overlaps(robot, all);
  return std::make_shared<const CollisionShapes>(std::move(all));
}

}  // namespace prowl

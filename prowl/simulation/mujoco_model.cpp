#include "prowl/simulation/mujoco_model.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "prowl/error.hpp"
#include "prowl/mjcf/mujoco_log.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/simulation/collision_shapes.hpp"

namespace prowl {
namespace {

constexpr double kSmallestBall = 1e-3;  // [m] for contacts without a radius: corners of flat feet
constexpr double kPatchDepth = 0.2;     // [m] thickness of the block under a patch

// Contact parameters: see docs/simulation.md for the measurements. Penetrations decay, critically
// damped, with this time constant: four default steps; MuJoCo's lower bound is two.
constexpr double kTimeConstant = 2e-3;  // [s]
constexpr double kImpedance[mjNIMP] = {0.99, 0.999, 1e-4, 0.5, 2.0};
constexpr double kFrictionToNormal = 10.0;  // impedance ratio: sticking feet creep ten times less

/// Rotation of every body to the world, nominal posture.
std::vector<Eigen::Matrix3d> nominal_rotations(const RobotModel& robot, const BodyTree& tree) {
  std::vector<Eigen::Matrix3d> rotations;
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    const RigidBody& body = tree.bodies[b];
    if (b == 0) {
      rotations.push_back(base_rotation(robot.nominal_configuration()));
      continue;
    }
    const double angle = body.prismatic ? 0.0 : robot.nominal_configuration()(6 + static_cast<Eigen::Index>(b));
    rotations.push_back(rotations[body.parent] * body.placement.linear() * Eigen::AngleAxisd(angle, body.axis));
  }
  return rotations;
}

void copy(const Eigen::Vector3d& from, double* to) { std::copy(from.begin(), from.end(), to); }

void copy_rotation(const Eigen::Matrix3d& R, double* quaternion) {
  const Eigen::Quaterniond r(R);
  Eigen::Map<Eigen::Vector4d>(quaternion) << r.w(), r.x(), r.y(), r.z();
}

void set_inertia(const RigidBody& from, double scale, mjsBody* to) {
  // Principal axes by Eigen: MuJoCo's own have fewer correct digits.
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> principal(from.inertia);
  Eigen::Matrix3d axes = principal.eigenvectors();
  if (axes.determinant() < 0.0) axes.col(0) *= -1.0;
  to->explicitinertial = true;
  to->mass = scale * from.mass;
  copy(from.center, to->ipos);
  copy(scale * principal.eigenvalues(), to->inertia);
  copy_rotation(axes, to->iquat);
}

void add_contact_law(mjsGeom* geom) {
  geom->condim = 3;
  geom->solref[0] = kTimeConstant;
  geom->solref[1] = 1.0;
  std::copy(std::begin(kImpedance), std::end(kImpedance), geom->solimp);
}

// Bits of what may touch (contype) and what it touches (conaffinity): surfaces touch contacts and shapes, shapes touch
// contacts and each other. A ball never touches a ball: feet side by side are not a fault.
constexpr int kGround = 1, kShape = 2;

void add_ball(const ContactPoint& contact, const BodyTree::Point& point, const Eigen::Vector3d& up, mjsBody* body) {
  mjsGeom* const geom = mjs_addGeom(body, nullptr);
  mjs_setName(geom->element, ("contact " + contact.name).c_str());
  geom->type = mjGEOM_SPHERE;
  geom->size[0] = std::max(contact.radius, kSmallestBall);
  // Raises the small ball of a corner: its lowest point in the nominal posture is the corner.
  copy(point.position + (geom->size[0] - contact.radius) * up, geom->pos);
  geom->contype = 0;
  geom->conaffinity = kGround | kShape;
  add_contact_law(geom);
}

void add_shape(const CollisionShape& from, std::size_t index, mjSpec* spec, mjsBody* body) {
  const RobotVisual& shape = from.shape;
  const std::string name = fmt::format("shape {} {}", index, shape.link);
  mjsGeom* const geom = mjs_addGeom(body, nullptr);
  mjs_setName(geom->element, name.c_str());
  const Eigen::Vector3d& size = shape.size;
  switch (shape.kind) {
    case RobotVisual::Kind::box:
      geom->type = mjGEOM_BOX;
      copy(0.5 * size, geom->size);
      break;
    case RobotVisual::Kind::sphere:
      geom->type = mjGEOM_SPHERE;
      geom->size[0] = size.x();
      break;
    case RobotVisual::Kind::cylinder:
    case RobotVisual::Kind::capsule:
      geom->type = shape.kind == RobotVisual::Kind::capsule ? mjGEOM_CAPSULE : mjGEOM_CYLINDER;
      geom->size[0] = size.x();
      geom->size[1] = 0.5 * size.z();
      break;
    case RobotVisual::Kind::mesh: {
      geom->type = mjGEOM_MESH;
      mjsMesh* const mesh = mjs_addMesh(spec, nullptr);
      mjs_setName(mesh->element, name.c_str());
      mesh->inertia = mjMESH_INERTIA_CONVEX;
      mjs_setFloat(mesh->uservert, from.hull.data(), static_cast<int>(from.hull.size()));
      mjs_setString(geom->meshname, name.c_str());
    }
  }
  copy(shape.placement.translation(), geom->pos);
  copy_rotation(shape.placement.linear(), geom->quat);
  geom->contype = kShape;
  geom->conaffinity = from.misses_ground ? kShape : kShape | kGround;
  add_contact_law(geom);
}

void add_surface(const Surface& surface, double friction, mjSpec* spec, mjsBody* world) {
  mjsGeom* const geom = mjs_addGeom(world, nullptr);
  mjs_setName(geom->element, ("surface " + surface.name).c_str());
  Eigen::Matrix3d R;
  R << surface.axes(), surface.normal;
  copy(surface.point, geom->pos);
  copy_rotation(R, geom->quat);
  if (surface.patch.empty()) {
    geom->type = mjGEOM_PLANE;
    geom->size[2] = 1.0;  // grid spacing for rendering, unused
  } else {
    std::vector<float> corners;
    for (const double z : {0.0, -kPatchDepth}) {
      for (const Eigen::Vector2d& corner : surface.patch) {
        for (const double value : {corner.x(), corner.y(), z}) corners.push_back(static_cast<float>(value));
      }
    }
    mjsMesh* const mesh = mjs_addMesh(spec, nullptr);
    mjs_setName(mesh->element, ("surface " + surface.name).c_str());
    mjs_setFloat(mesh->uservert, corners.data(), static_cast<int>(corners.size()));
    geom->type = mjGEOM_MESH;
    mjs_setString(geom->meshname, ("surface " + surface.name).c_str());
  }
  geom->contype = kGround;
  geom->conaffinity = 0;
  geom->priority = 1;  // use this geom's friction, not the larger of the two
  geom->friction[0] = friction;
  add_contact_law(geom);
}

void set_options(const PhysicsOptions& options, mjSpec* spec) {
  spec->compiler.degree = false;
  spec->compiler.alignfree = false;
  spec->compiler.usethread = false;
  mjOption& option = spec->option;
  option.timestep = options.step;
  copy({0.0, 0.0, -RobotModel::kGravity}, option.gravity);
  option.integrator = mjINT_EULER;
  option.solver = mjSOL_NEWTON;
  option.cone = mjCONE_ELLIPTIC;
  option.impratio = kFrictionToNormal;
  option.tolerance = 1e-10;
  option.disableflags |= mjDSBL_AUTORESET;
}

}  // namespace

std::unique_ptr<mjModel, MujocoModel::Delete> compile(mjSpec* spec) {
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  return std::unique_ptr<mjModel, MujocoModel::Delete>(mj_compile(spec, nullptr));
}

MujocoSpec make_mujoco_spec(const RobotModel& robot, const std::vector<Surface>& surfaces,
                            const PhysicsOptions& options) {
  silence_mujoco();
  MujocoSpec spec(mj_makeSpec());
  set_options(options, spec.get());
  const BodyTree tree = body_tree(robot);
  mjsBody* const world = mjs_findBody(spec.get(), "world");
  const Eigen::VectorXd armature = robot.armature();
  std::vector<mjsBody*> bodies;
  for (std::size_t b = 0; b < tree.bodies.size(); ++b) {
    const RigidBody& from = tree.bodies[b];
    mjsBody* const body = mjs_addBody(b == 0 ? world : bodies[from.parent], nullptr);
    bodies.push_back(body);
    mjs_setName(body->element, from.name.c_str());
    copy(from.placement.translation(), body->pos);
    copy_rotation(from.placement.linear(), body->quat);
    set_inertia(from, options.mass_scale * (options.body_scales.empty() ? 1.0 : options.body_scales[b]), body);
    if (b == 0) {
      copy(from.center + options.base_center, body->ipos);
      mjsJoint* const base = mjs_addFreeJoint(body);
      base->align = mjALIGNFREE_FALSE;
      continue;
    }
    const auto j = static_cast<Eigen::Index>(b - 1);
    mjsJoint* const joint = mjs_addJoint(body, nullptr);
    mjs_setName(joint->element, from.name.c_str());
    joint->type = from.prismatic ? mjJNT_SLIDE : mjJNT_HINGE;
    copy(from.axis, joint->axis);
    joint->armature = armature(j);
    joint->damping[0] = robot.losses().damping(j);
    joint->frictionloss = robot.losses().dry_friction(j);
    joint->range[0] = robot.position_lower()(j);
    joint->range[1] = robot.position_upper()(j);
    joint->limited =
        std::isfinite(joint->range[0]) && std::isfinite(joint->range[1]) ? mjLIMITED_TRUE : mjLIMITED_FALSE;
    mjsActuator* const actuator = mjs_addActuator(spec.get(), nullptr);
    mjs_setToMotor(actuator);
    mjs_setName(actuator->element, from.name.c_str());
    actuator->trntype = mjTRN_JOINT;
    mjs_setString(actuator->target, from.name.c_str());
  }
  const std::vector<Eigen::Matrix3d> rotations = nominal_rotations(robot, tree);
  for (std::size_t c = 0; c < tree.points.size(); ++c) {
    const auto body = static_cast<std::size_t>(tree.points[c].body);
    const Eigen::Vector3d up = rotations[body].transpose() * Eigen::Vector3d::UnitZ();
    add_ball(robot.contacts()[c], tree.points[c], up, bodies[body]);
  }
  if (options.collisions) {
    const CollisionShapes& collisions = *options.collisions;
    for (std::size_t i = 0; i < collisions.shapes.size(); ++i)
      add_shape(collisions.shapes[i], i, spec.get(), bodies[static_cast<std::size_t>(collisions.shapes[i].shape.body)]);
    for (const auto& [one, other] : collisions.apart) {
      mjsExclude* const exclude = mjs_addExclude(spec.get());
      mjs_setString(exclude->bodyname1, tree.bodies[static_cast<std::size_t>(one)].name.c_str());
      mjs_setString(exclude->bodyname2, tree.bodies[static_cast<std::size_t>(other)].name.c_str());
    }
  }
  for (const Surface& surface : surfaces) {
    add_surface(surface, options.friction_scale * options.friction.value_or(surface.friction), spec.get(), world);
  }
  return spec;
}

MujocoModel make_mujoco_model(const RobotModel& robot, const std::vector<Surface>& surfaces,
                              const PhysicsOptions& options) {
  const MujocoSpec spec = make_mujoco_spec(robot, surfaces, options);
  MujocoModel result;
  result.model = compile(spec.get());
  if (!result.model) throw InputError(fmt::format("robot '{}' in MuJoCo: {}", robot.name(), mjs_getError(spec.get())));
  const mjModel* const model = result.model.get();
  result.base_body = mj_name2id(model, mjOBJ_BODY, "base");
  for (int j = 0; j < robot.nu(); ++j) {
    const std::string& name = robot.joint_names()[j];
    const int joint = mj_name2id(model, mjOBJ_JOINT, name.c_str());
    if (joint < 0 || model->jnt_dofadr[joint] != 6 + j || mj_name2id(model, mjOBJ_ACTUATOR, name.c_str()) != j) {
      throw InputError(fmt::format("robot '{}' in MuJoCo: joint '{}' has another index", robot.name(), name));
    }
  }
  result.contact_of_geom.assign(static_cast<std::size_t>(model->ngeom), -1);
  result.surface_of_geom = result.shape_of_geom = result.contact_of_geom;
  for (std::size_t i = 0; options.collisions && i < options.collisions->shapes.size(); ++i) {
    const std::string name = fmt::format("shape {} {}", i, options.collisions->shapes[i].shape.link);
    result.shape_of_geom[mj_name2id(model, mjOBJ_GEOM, name.c_str())] = static_cast<int>(i);
  }
  for (std::size_t c = 0; c < robot.contacts().size(); ++c) {
    const int geom = mj_name2id(model, mjOBJ_GEOM, ("contact " + robot.contacts()[c].name).c_str());
    result.contact_of_geom[geom] = static_cast<int>(c);
    result.geom_of_contact.push_back(geom);
  }
  for (std::size_t s = 0; s < surfaces.size(); ++s) {
    const int geom = mj_name2id(model, mjOBJ_GEOM, ("surface " + surfaces[s].name).c_str());
    result.surface_of_geom[geom] = static_cast<int>(s);
  }
  return result;
}

}  // namespace prowl

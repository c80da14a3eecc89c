#pragma once

#include <mujoco/mujoco.h>

#include <memory>
#include <vector>

#include "prowl/simulation/physics.hpp"

namespace prowl {

struct MujocoModel {
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
  };
  std::unique_ptr<mjModel, Delete> model;
  int base_body = 0;
  std::vector<int> contact_of_geom;  ///< index of the robot's contact, or -1
  std::vector<int> geom_of_contact;
  std::vector<int> surface_of_geom;  ///< index of the surface, or -1
  std::vector<int> shape_of_geom;    ///< index of the collision shape, or -1
};

struct DeleteMujocoSpec {
  void operator()(mjSpec* spec) const { mj_deleteSpec(spec); }
};
using MujocoSpec = std::unique_ptr<mjSpec, DeleteMujocoSpec>;

/// Compiles a model; null with a reason in mjs_getError(). One at a time: MuJoCo does not guarantee that several
/// threads may, and ThreadSanitizer reports a race.
std::unique_ptr<mjModel, MujocoModel::Delete> compile(mjSpec* spec);

/// The model of physics.hpp before MuJoCo compiles it.
MujocoSpec make_mujoco_spec(const RobotModel& robot, const std::vector<Surface>& surfaces,
                            const PhysicsOptions& options);

/// Compiles the model of physics.hpp, degrees of freedom in the robot's order. Throws InputError
/// with MuJoCo's reason.
MujocoModel make_mujoco_model(const RobotModel& robot, const std::vector<Surface>& surfaces,
                              const PhysicsOptions& options);

}  // namespace prowl

// The model as a file: MuJoCo reads it back as the model that is simulated.
#include "prowl/simulation/mujoco_xml.hpp"

#include <gtest/gtest.h>

#include <span>

#include "prowl/simulation/mujoco_model.hpp"
#include "prowl/simulation/mujoco_state.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

std::vector<Surface> floor_and_block() {
  Surface block{.name = "block",
                .point = {0.8, 0.1, 0.1},
                .normal = Eigen::Vector3d(0.1, 0.0, 1.0).normalized(),
                .friction = 0.7};
  block.patch = {{-0.3, -0.4}, {0.3, -0.4}, {1.0 / 3.0, 0.4}, {-0.3, 0.4}};
  return {Surface{}, block};
}

MujocoModel read(const std::string& xml) {
  std::array<char, 500> error{};
  const MujocoSpec spec(mj_parseXMLString(xml.c_str(), nullptr, error.data(), error.size()));
  if (!spec) throw std::runtime_error(error.data());
  MujocoModel result;
  result.model.reset(mj_compile(spec.get(), nullptr));
  if (!result.model) throw std::runtime_error(mjs_getError(spec.get()));
  return result;
}

template <typename Number>
void expect_same(const char* what, const Number* a, const Number* b, int size) {
  double largest = 0.0;
  for (int i = 0; i < size; ++i)
    largest = std::max(largest, std::abs(static_cast<double>(a[i]) - static_cast<double>(b[i])));
  EXPECT_LE(largest, 1e-14) << what;  // MuJoCo turns meshes to their principal axes again
}

TEST(MujocoXml, ReadsBackAsTheModelThatIsSimulated) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}) {
    SCOPED_TRACE(robot.name());
    const PhysicsOptions options{.step = 1.0 / 3000.0, .mass_scale = 1.1, .friction = {}};
    const MujocoModel simulated = make_mujoco_model(robot, floor_and_block(), options);
    const MujocoModel from_file = read(mujoco_xml(robot, floor_and_block(), options));
    const mjModel *a = simulated.model.get(), *b = from_file.model.get();
    ASSERT_EQ(a->nbody, b->nbody);
    ASSERT_EQ(a->ngeom, b->ngeom);
    ASSERT_EQ(a->nv, robot.nv());
    ASSERT_EQ(b->nv, robot.nv());
    ASSERT_EQ(b->nu, robot.nu());
    ASSERT_EQ(a->nmeshvert, b->nmeshvert);
    expect_same("body_pos", a->body_pos, b->body_pos, 3 * a->nbody);
    expect_same("body_quat", a->body_quat, b->body_quat, 4 * a->nbody);
    expect_same("body_mass", a->body_mass, b->body_mass, a->nbody);
    expect_same("body_inertia", a->body_inertia, b->body_inertia, 3 * a->nbody);
    expect_same("body_ipos", a->body_ipos, b->body_ipos, 3 * a->nbody);
    expect_same("body_iquat", a->body_iquat, b->body_iquat, 4 * a->nbody);
    expect_same("jnt_axis", a->jnt_axis, b->jnt_axis, 3 * a->njnt);
    expect_same("jnt_range", a->jnt_range, b->jnt_range, 2 * a->njnt);
    expect_same("jnt_limited", a->jnt_limited, b->jnt_limited, a->njnt);
    expect_same("dof_damping", a->dof_damping, b->dof_damping, a->nv);
    expect_same("actuator_gear", a->actuator_gear, b->actuator_gear, 6 * a->nu);
    expect_same("actuator_trnid", a->actuator_trnid, b->actuator_trnid, 2 * a->nu);
    expect_same("geom_pos", a->geom_pos, b->geom_pos, 3 * a->ngeom);
    expect_same("geom_quat", a->geom_quat, b->geom_quat, 4 * a->ngeom);
    expect_same("geom_size", a->geom_size, b->geom_size, 3 * a->ngeom);
    expect_same("geom_friction", a->geom_friction, b->geom_friction, 3 * a->ngeom);
    expect_same("geom_priority", a->geom_priority, b->geom_priority, a->ngeom);
    expect_same("geom_contype", a->geom_contype, b->geom_contype, a->ngeom);
    expect_same("geom_conaffinity", a->geom_conaffinity, b->geom_conaffinity, a->ngeom);
    expect_same("geom_solref", a->geom_solref, b->geom_solref, mjNREF * a->ngeom);
    expect_same("geom_solimp", a->geom_solimp, b->geom_solimp, mjNIMP * a->ngeom);
    expect_same("mesh_vert", a->mesh_vert, b->mesh_vert, 3 * a->nmeshvert);
    expect_same("gravity", a->opt.gravity, b->opt.gravity, 3);
    EXPECT_EQ(a->opt.timestep, b->opt.timestep);
    EXPECT_EQ(a->opt.impratio, b->opt.impratio);
    EXPECT_EQ(a->opt.tolerance, b->opt.tolerance);
    EXPECT_EQ(a->opt.cone, b->opt.cone);
    EXPECT_EQ(a->opt.integrator, b->opt.integrator);
    EXPECT_EQ(a->opt.disableflags, b->opt.disableflags);
    for (int j = 0; j < robot.nu(); ++j) {
      EXPECT_EQ(mj_id2name(b, mjOBJ_ACTUATOR, j), robot.joint_names()[j]);
    }
  }
}

TEST(MujocoXml, LeavesTheDigitsOfOtherFilesAlone) {
  const auto other = [] {
    const MujocoSpec spec(mj_makeSpec());
    spec->option.timestep = 1.0 / 3000.0;
    if (mjModel* model = mj_compile(spec.get(), nullptr)) mj_deleteModel(model);
    std::string xml(10000, '\0');
    EXPECT_EQ(mj_saveXMLString(spec.get(), xml.data(), static_cast<int>(xml.size()), nullptr, 0), 0);
    return xml;
  };
  const std::string before = other();
  mujoco_xml(test::hyq(), {Surface{}}, {});
  EXPECT_EQ(other(), before);
}

}  // namespace
}  // namespace prowl

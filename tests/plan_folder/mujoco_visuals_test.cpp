// What MuJoCo shows of a robot: each shape is where the URDF says, and the physics does not see it.
#include "prowl/plan_folder/mujoco_visuals.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <limits>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/simulation/mujoco_state.hpp"
#include "prowl/simulation/mujoco_xml.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using Model = std::unique_ptr<mjModel, decltype(&mj_deleteModel)>;
using Data = std::unique_ptr<mjData, decltype(&mj_deleteData)>;

constexpr int kGroup = 2;

Model load(const std::string& xml) {
  std::array<char, 500> error{};
  mjSpec* const spec = mj_parseXMLString(xml.c_str(), nullptr, error.data(), error.size());
  if (!spec) throw std::runtime_error(error.data());
  Model model(mj_compile(spec, nullptr), mj_deleteModel);
  const std::string reason = mjs_getError(spec);
  mj_deleteSpec(spec);
  if (!model) throw std::runtime_error(reason);
  return model;
}

std::string bare(const RobotModel& robot) { return mujoco_xml(robot, {Surface{}}, {}); }

std::string shown(const RobotModel& robot, const RobotLook& look) {
  return add_mujoco_visuals(bare(robot), robot, look);
}

RobotLook look_of(const RobotModel& robot) {
  std::vector<std::string> warnings;
  RobotLook look = robot_look(robot, test::test_search(), warnings);
  EXPECT_TRUE(warnings.empty());
  return look;
}

struct Box {
  Eigen::Vector3d lower = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d upper = -lower;

  void take(const Eigen::Vector3d& point) {
    lower = lower.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
};

/// Around all mesh geoms of a body, in the world.
Box seen_by_mujoco(const mjModel& model, const mjData& data, int body) {
  Box box;
  for (int g = 0; g < model.ngeom; ++g) {
    if (model.geom_bodyid[g] != body || model.geom_type[g] != mjGEOM_MESH) continue;
    const int mesh = model.geom_dataid[g];
    const Eigen::Map<const Eigen::Vector3d> position(data.geom_xpos + 3 * g);
    const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(data.geom_xmat + 9 * g);
    for (int v = 0; v < model.mesh_vertnum[mesh]; ++v) {
      const Eigen::Map<const Eigen::Vector3f> vertex(model.mesh_vert + 3 * (model.mesh_vertadr[mesh] + v));
      box.take(position + rotation * vertex.cast<double>());
    }
  }
  return box;
}

/// The same from the look.
Box expected(const RobotLook& look, int body, const Eigen::Isometry3d& placement) {
  Box box;
  for (const RobotVisual& visual : look.visuals) {
    if (visual.body != body || visual.kind != RobotVisual::Kind::mesh) continue;
    for (const VisualMesh& part : look.meshes.at(visual.mesh)) {
      for (std::size_t v = 0; v < part.num_vertices(); ++v) {
        const Eigen::Map<const Eigen::Vector3f> vertex(&part.positions[3 * v]);
        box.take(placement * visual.placement * visual.size.cwiseProduct(vertex.cast<double>()));
      }
    }
  }
  return box;
}

TEST(MujocoVisuals, AreWhereTheUrdfPutsThem) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}) {
    SCOPED_TRACE(robot.name());
    const RobotLook look = look_of(robot);
    const Model model = load(shown(robot, look));
    const Data data(mj_makeData(model.get()), mj_deleteData);
    const Eigen::VectorXd q = test::RandomStates(robot, 5).configuration();
    Eigen::Map<Eigen::VectorXd>(data->qpos, model->nq) = mujoco_qpos(q);
    mj_forward(model.get(), data.get());
    BodyPlacements placements(robot);
    const std::vector<Eigen::Isometry3d>& bodies = placements.at(q);
    const BodyTree tree = body_tree(robot);
    int with_mesh = 0;
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const Box box = expected(look, static_cast<int>(b), bodies[b]);
      if (!box.lower.allFinite()) continue;
      ++with_mesh;
      const Box seen = seen_by_mujoco(*model, *data, mj_name2id(model.get(), mjOBJ_BODY, tree.bodies[b].name.c_str()));
      EXPECT_LT((seen.lower - box.lower).norm(), 1e-5) << tree.bodies[b].name;
      EXPECT_LT((seen.upper - box.upper).norm(), 1e-5) << tree.bodies[b].name;
    }
    EXPECT_GT(with_mesh, robot.nu() / 2);
  }
}

TEST(MujocoVisuals, LeaveThePhysicsAlone) {
  for (const RobotModel& robot : {test::hyq(), test::go2()}) {
    SCOPED_TRACE(robot.name());
    const std::array<Model, 2> models = {load(bare(robot)), load(shown(robot, look_of(robot)))};
    const mjModel &a = *models[0], &b = *models[1];
    ASSERT_EQ(a.nbody, b.nbody);
    EXPECT_GT(b.ngeom, a.ngeom);
    for (int i = 0; i < a.nbody; ++i) EXPECT_EQ(a.body_mass[i], b.body_mass[i]);
    for (int i = 0; i < 3 * a.nbody; ++i) EXPECT_EQ(a.body_inertia[i], b.body_inertia[i]);
    int visuals = 0;
    for (int g = 0; g < b.ngeom; ++g) {
      if (b.geom_group[g] != kGroup) continue;
      ++visuals;
      EXPECT_EQ(b.geom_contype[g] + b.geom_conaffinity[g], 0);
    }
    EXPECT_EQ(visuals, b.ngeom - a.ngeom);
    // Falls onto the floor and stays there: the states are the same to the last bit.
    std::array<Eigen::VectorXd, 2> ends;
    for (std::size_t i : {0, 1}) {
      const Data data(mj_makeData(models[i].get()), mj_deleteData);
      Eigen::Map<Eigen::VectorXd>(data->qpos, a.nq) = mujoco_qpos(robot.nominal_configuration());
      int most_contacts = 0;
      for (int step = 0; step < 500; ++step) {
        mj_step(models[i].get(), data.get());
        most_contacts = std::max(most_contacts, data->ncon);
      }
      EXPECT_GE(most_contacts, 4);
      ends[i] = Eigen::Map<Eigen::VectorXd>(data->qpos, a.nq);
    }
    EXPECT_EQ(ends[0], ends[1]);
  }
}

TEST(MujocoVisuals, ShapesHaveTheirSizes) {
  const RobotModel robot = test::hyq();
  using Kind = RobotVisual::Kind;
  RobotLook look;
  for (const auto& [kind, size] :
       std::initializer_list<std::pair<Kind, Eigen::Vector3d>>{{Kind::box, {0.2, 0.4, 0.0}},
                                                               {Kind::sphere, {0.3, 0.3, 0.3}},
                                                               {Kind::cylinder, {0.1, 0.1, 0.6}},
                                                               {Kind::capsule, {0.1, 0.1, 0.6}}}) {
    RobotVisual& visual = look.visuals.emplace_back();
    visual.kind = kind;
    visual.size = size;
    visual.colour = Eigen::Vector3d(0.25, 0.5, 1.0);
  }
  const Model model = load(shown(robot, look));
  const std::vector<std::pair<int, Eigen::Vector3d>> sizes = {{mjGEOM_BOX, {0.1, 0.2, 5e-6}},
                                                              {mjGEOM_SPHERE, {0.3, 0.0, 0.0}},
                                                              {mjGEOM_CYLINDER, {0.1, 0.3, 0.0}},
                                                              {mjGEOM_CAPSULE, {0.1, 0.3, 0.0}}};
  std::size_t found = 0;
  for (int g = 0; g < model->ngeom; ++g) {
    if (model->geom_group[g] != kGroup) continue;
    ASSERT_LT(found, sizes.size());
    EXPECT_EQ(model->geom_type[g], sizes[found].first);
    EXPECT_LT((Eigen::Map<Eigen::Vector3d>(model->geom_size + 3 * g) - sizes[found].second).norm(), 1e-12);
    EXPECT_EQ(Eigen::Map<Eigen::Vector4f>(model->geom_rgba + 4 * g), Eigen::Vector4f(0.25F, 0.5F, 1.0F, 1.0F));
    ++found;
  }
  EXPECT_EQ(found, sizes.size());
}

TEST(MujocoVisuals, TakeMeshesThatMujocoAloneWouldRefuse) {
  const RobotModel robot = test::hyq();
  RobotLook look;
  VisualMesh triangle{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, {}};
  VisualMesh nothing{{0, 0, 0, 1, 0, 0, 2, 0, 0}, {0, 1, 2}, {}};
  look.meshes["one \"of\" <two>.stl"] = {triangle, nothing};
  for (const double scale : {1.0, -0.5, 1.0}) {
    RobotVisual& visual = look.visuals.emplace_back();
    visual.kind = RobotVisual::Kind::mesh;
    visual.mesh = look.meshes.begin()->first;
    visual.size.x() = scale;
  }
  const Model model = load(shown(robot, look));
  EXPECT_EQ(model->nmesh, 2) << "one a scale, and the part without area is left out";
  int visuals = 0;
  for (int g = 0; g < model->ngeom; ++g) visuals += model->geom_group[g] == kGroup;
  EXPECT_EQ(visuals, 3);
}

}  // namespace
}  // namespace prowl

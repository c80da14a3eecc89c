// Keyframes and their model as MuJoCo loads them: bodies stand and move as in the plan.
#include "prowl/plan_folder/mujoco_keyframes.hpp"

#include <gtest/gtest.h>
#include <mujoco/mujoco.h>

#include <array>
#include <fstream>

#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/simulation/mujoco_xml.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/solved_task.hpp"

namespace prowl {
namespace {

/// Random states in place of a plan's: large angles and velocities show what is mixed up.
Trajectory random_motion(const RobotModel& robot) {
  test::RandomStates states(robot, 11);
  Trajectory motion;
  for (int i = 0; i < 20; ++i) {
    motion.nodes.push_back({.time = 0.1 * i + 1.0 / 3.0,
                            .phase = 0,
                            .q = states.configuration(),
                            .v = states.velocity(),
                            .a = {},
                            .tau = states.torque(),
                            .force = {}});
  }
  return motion;
}

/// A shipped task, and if the keyframes are a file of their own.
class Keyframes : public testing::TestWithParam<std::tuple<const char*, bool>> {};

TEST_P(Keyframes, StandAndMoveAsThePlan) {
  const auto& [name, apart] = GetParam();
  const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/" + name + ".toml", test::test_search());
  const MotionProblem& problem = task.problem;
  const RobotModel& robot = problem.robot;
  const Trajectory motion = random_motion(robot);
  test::TempFolder folder;
  const std::string bare = mujoco_xml(robot, problem.surfaces, {});
  folder.write("model.xml", bare);
  const auto file = folder.write("keys.xml", apart ? mujoco_keyframes_xml(problem, motion, "model.xml")
                                                   : add_mujoco_keyframes(bare, problem, motion));

  std::array<char, 500> error{};
  const std::unique_ptr<mjModel, decltype(&mj_deleteModel)> model(
      mj_loadXML(file.c_str(), nullptr, error.data(), error.size()), mj_deleteModel);
  ASSERT_TRUE(model) << error.data();
  const std::unique_ptr<mjData, decltype(&mj_deleteData)> data(mj_makeData(model.get()), mj_deleteData);
  ASSERT_EQ(model->nkey, static_cast<int>(motion.nodes.size()));

  const BodyTree tree = body_tree(robot);
  BodyPlacements placements(robot), before(robot), after(robot);
  constexpr double kStep = 1e-5;  // [s]
  for (int k = 0; k < model->nkey; ++k) {
    const TrajectoryPoint& point = motion.nodes[k];
    mj_resetDataKeyframe(model.get(), data.get(), k);
    mj_forward(model.get(), data.get());
    EXPECT_EQ(data->time, point.time);
    EXPECT_EQ(Eigen::Map<Eigen::VectorXd>(data->ctrl, model->nu), point.tau);
    const std::vector<Eigen::Isometry3d>& bodies = placements.at(point.q);
    const Eigen::VectorXd rate = tangent_rate(point);
    const std::vector<Eigen::Isometry3d>& past = before.at(integrate(point.q, -kStep * rate));
    const std::vector<Eigen::Isometry3d>& future = after.at(integrate(point.q, kStep * rate));
    for (std::size_t b = 0; b < bodies.size(); ++b) {
      const int id = mj_name2id(model.get(), mjOBJ_BODY, tree.bodies[b].name.c_str());
      ASSERT_GE(id, 0) << tree.bodies[b].name;
      const Eigen::Map<const Eigen::Vector3d> position(data->xpos + 3 * id);
      const Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>> rotation(data->xmat + 9 * id);
      EXPECT_LT((position - bodies[b].translation()).norm(), 1e-12) << tree.bodies[b].name;
      EXPECT_LT((rotation - bodies[b].linear()).norm(), 1e-12) << tree.bodies[b].name;
      std::array<double, 6> velocity{};  // angular, linear; world axes, at the body's origin
      mj_objectVelocity(model.get(), data.get(), mjOBJ_XBODY, id, velocity.data(), 0);
      const Eigen::Vector3d linear = (future[b].translation() - past[b].translation()) / (2.0 * kStep);
      const Eigen::AngleAxisd turn(future[b].linear() * past[b].linear().transpose());
      const Eigen::Vector3d angular = turn.angle() / (2.0 * kStep) * turn.axis();
      EXPECT_LT((Eigen::Map<Eigen::Vector3d>(velocity.data() + 3) - linear).norm(), 1e-6) << tree.bodies[b].name;
      EXPECT_LT((Eigen::Map<Eigen::Vector3d>(velocity.data()) - angular).norm(), 1e-6) << tree.bodies[b].name;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, Keyframes,
                         testing::Combine(testing::Values("hyq/step", "hyq/wall", "talos/squat"), testing::Bool()));

}  // namespace
}  // namespace prowl

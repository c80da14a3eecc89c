// A robot is the same from its MJCF file: MuJoCo's mass matrix, places and limits.
#include "prowl/mjcf/mjcf_robot.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/mjcf/mjcf_model.hpp"
#include "prowl/model/robot_model.hpp"
#include "prowl/simulation/mujoco_state.hpp"
#include "prowl/simulation/mujoco_xml.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/test_files.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using testing::HasSubstr;

/// Defaults, degrees, two joints in a body, joints beside the body's origin, a reference position, a capsule, a
/// geared motor, a body without a joint, and inertias from shapes.
const std::string kBiped = R"(
<mujoco model="biped">
  <compiler angle="degree" autolimits="true"/>
  <default>
    <joint armature="0.01" axis="0 1 0"/>
    <default class="hip"><joint range="-40 70" actuatorfrcrange="-60 60"/></default>
  </default>
  <worldbody>
    <geom type="plane" size="1 1 1"/>
    <body name="trunk" pos="0 0 1" euler="10 20 30">
      <freejoint/>
      <inertial pos="0.01 0.02 0.1" mass="12" fullinertia="0.3 0.25 0.15 0.01 -0.02 0.005"/>
      <geom type="box" size="0.1 0.1 0.2"/>
      <body name="left_thigh" pos="0 0.1 -0.2" euler="0 90 5">
        <joint name="left_roll" axis="1 0 0.2" pos="0.02 0 0.01" class="hip"/>
        <joint name="left_pitch" pos="0 0.03 0" class="hip" ref="15"/>
        <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.04" mass="3"/>
        <body name="left_shin" pos="0.4 0 0">
          <joint name="left_knee" pos="0 0 0.01" range="5 150" armature="0.02"/>
          <geom type="capsule" fromto="0 0 0 0.4 0 0" size="0.03" mass="2"/>
          <body name="left_sole" pos="0.4 0 0" euler="0 -90 0"><geom type="sphere" size="0.035" mass="0.2"/></body>
        </body>
      </body>
      <body name="right_thigh" pos="0 -0.1 -0.2">
        <joint name="right_slide" type="slide" axis="0 0 1" range="-0.1 0.1"/>
        <geom type="ellipsoid" size="0.05 0.05 0.2" pos="0 0 -0.2" mass="3"/>
        <body name="right_shin" pos="0 0 -0.4">
          <joint name="right_knee" range="5 150" damping="0.1" frictionloss="0.2"/>
          <geom type="cylinder" size="0.03 0.2" pos="0 0 -0.2" mass="2"/>
        </body>
      </body>
    </body>
  </worldbody>
  <actuator>
    <motor joint="left_roll" gear="10" ctrlrange="-5 5"/>
    <motor joint="left_pitch" gear="10" ctrlrange="-7 7"/>
    <position joint="left_knee" kp="100" forcerange="-80 90"/>
    <position joint="right_knee" kp="100"/>
  </actuator>
</mujoco>
)";

RobotModel robot_of(const MjcfRobot& mjcf, const std::filesystem::path& folder) {
  RobotDescription description{.name = mjcf.name,
                               .urdf = folder / "robot.urdf",
                               .urdf_text = mjcf.urdf,
                               .contacts = {},
                               .nominal_joints = {},
                               .limits = {}};
  description.armature = mjcf.armature;
  const MjcfModel model(folder / "robot.xml");
  for (int joint = 1; joint < model->njnt; ++joint) {  // as prowl new robot guesses what MJCF cannot say
    JointLimits& limits = description.limits[model.name_of(mjOBJ_JOINT, joint)];
    limits.velocity = 10.0;
    if (!model.torque_limit(joint)) limits.torque = 1.0;
    if (!model->jnt_limited[joint]) limits.position_lower = -1.0, limits.position_upper = 1.0;
  }
  return RobotModel(description);
}

/// Mass matrix and places of the bodies at random states, against MuJoCo's.
void expect_same_robot(const RobotModel& robot, const MjcfModel& model) {
  const std::unique_ptr<mjData, void (*)(mjData*)> data(mj_makeData(&*model), mj_deleteData);
  RigidBodyTerms terms(robot);
  test::RandomStates states(robot, 5);
  ASSERT_EQ(robot.nv(), model->nv);
  for (int trial = 0; trial < 20; ++trial) {
    const VectorXd q = states.configuration();
    const VectorXd qpos = mujoco_qpos(q);
    std::copy_n(qpos.data(), 7, data->qpos);
    MatrixXd to_mujoco = MatrixXd::Zero(robot.nv(), robot.nv());  // of velocities
    to_mujoco.topLeftCorner<3, 3>() = base_rotation(q);
    to_mujoco.block<3, 3>(3, 3).setIdentity();
    for (int j = 0; j < robot.nu(); ++j) {
      const int joint = mj_name2id(&*model, mjOBJ_JOINT, robot.joint_names()[j].c_str());
      ASSERT_GE(joint, 0);
      data->qpos[model->jnt_qposadr[joint]] = q(7 + j) + model->qpos0[model->jnt_qposadr[joint]];
      to_mujoco(model->jnt_dofadr[joint], 6 + j) = 1.0;
    }
    mj_forward(&*model, data.get());
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> theirs(robot.nv(), robot.nv());
    mj_fullM(&*model, data.get(), theirs.data());
    terms.update_with_derivatives(q, VectorXd::Zero(robot.nv()), VectorXd::Zero(robot.nv()));
    const MatrixXd M = terms.mass_matrix(), expected = to_mujoco.transpose() * theirs * to_mujoco;
    EXPECT_LT((M - expected).cwiseAbs().maxCoeff(), 1e-10 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(MjcfRobot, HasTheMassMatrixAndLimitsOfMujoco) {
  const test::TempFolder folder;
  const auto file = folder.write("robot.xml", kBiped);
  const MjcfRobot mjcf = read_mjcf(file, folder.path());
  const RobotModel robot = robot_of(mjcf, folder.path());
  const MjcfModel model(file);
  expect_same_robot(robot, model);

  const auto index = [&](const std::string& joint) {
    return std::ranges::find(robot.joint_names(), joint) - robot.joint_names().begin();
  };
  constexpr double kDegree = std::numbers::pi / 180.0;
  EXPECT_NEAR(robot.position_lower()(index("left_pitch")), -55.0 * kDegree, 1e-12) << "15 degrees are its 0";
  EXPECT_NEAR(robot.position_upper()(index("left_knee")), 150.0 * kDegree, 1e-12);
  EXPECT_DOUBLE_EQ(robot.torque_limit()(index("left_roll")), 50.0);
  EXPECT_DOUBLE_EQ(robot.torque_limit()(index("left_pitch")), 60.0) << "of the joint, less than of its motor";
  EXPECT_DOUBLE_EQ(robot.torque_limit()(index("left_knee")), 90.0);
  EXPECT_DOUBLE_EQ(robot.armature()(index("left_roll")), 0.01);
  EXPECT_DOUBLE_EQ(robot.armature()(index("left_knee")), 0.02);
  EXPECT_DOUBLE_EQ(robot.losses().damping(index("right_knee")), 0.1);
  EXPECT_DOUBLE_EQ(robot.losses().dry_friction(index("right_knee")), 0.2);
  EXPECT_DOUBLE_EQ(robot.losses().damping(index("left_knee")), 0.0);
  EXPECT_THAT(mjcf.notes, testing::UnorderedElementsAre(HasSubstr("left_pitch"), HasSubstr("right_slide")));
}

struct Shipped {
  const char* name;
  RobotModel (*robot)();
};
void PrintTo(const Shipped& robot, std::ostream* out) { *out << robot.name; }

class EveryMjcf : public testing::TestWithParam<Shipped> {};

/// A robot of a URDF, written as MJCF, and back.
TEST_P(EveryMjcf, IsTheRobotOfItsUrdf) {
  const RobotModel robot = GetParam().robot();
  const test::TempFolder folder;
  const auto file = folder.write("robot.xml", mujoco_xml(robot, {Surface{}}, {}));
  const MjcfRobot mjcf = read_mjcf(file, folder.path());
  EXPECT_EQ(mjcf.name, robot.name());
  const RobotModel again = robot_of(mjcf, folder.path());
  expect_same_robot(again, MjcfModel(file));
  EXPECT_NEAR(again.mass(), robot.mass(), 1e-10 * robot.mass());
  EXPECT_EQ(std::set<std::string>(again.joint_names().begin(), again.joint_names().end()),
            std::set<std::string>(robot.joint_names().begin(), robot.joint_names().end()));
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryMjcf,
                         testing::Values(Shipped{"HyQ", test::hyq}, Shipped{"ANYmalC", test::anymal_c},
                                         Shipped{"Solo12", test::solo12}, Shipped{"Go2", test::go2},
                                         Shipped{"Talos", test::talos}),
                         [](const auto& info) { return info.param.name; });

std::string message(const std::string& xml) {
  const test::TempFolder folder;
  const auto file = folder.write("robot.xml", xml);
  return test::message_of(folder.path(), [&] { read_mjcf(file, folder.path()); });
}

std::string with_bodies(const std::string& bodies, const std::string& more = "") {
  return "<mujoco><worldbody>" + bodies + "</worldbody>" + more + "</mujoco>";
}

TEST(MjcfRobot, WhatIsNoRobotIsRefused) {
  const std::string geom = "<geom size=\"0.1\"/>";
  const std::string arm = "<body name=\"arm\"><joint name=\"elbow\"/>" + geom + "</body>";
  const std::string base = "<body name=\"base\"><freejoint/>" + geom + "</body>";
  EXPECT_THAT(message("<mujoco><worldbody><boddy/></worldbody></mujoco>"),
              AllOf(HasSubstr("robot.xml: MuJoCo cannot read it"), HasSubstr("boddy")));
  EXPECT_THAT(message(with_bodies(arm)), HasSubstr("no body has a <freejoint>"));
  EXPECT_THAT(message(with_bodies(base + base.substr(0, 12) + "2" + base.substr(12))),
              HasSubstr("2 bodies have a free joint"));
  EXPECT_THAT(message(with_bodies(base + arm)), HasSubstr("joint 'elbow' is not behind the free joint of 'base'"));
  EXPECT_THAT(
      message(with_bodies("<body name=\"base\"><freejoint/>" + geom +
                          "<body name=\"arm\"><joint name=\"wrist\" type=\"ball\"/>" + geom + "</body></body>")),
      HasSubstr("joint 'wrist' is a ball; need hinges and slides"));
  const std::string legs = "<body name=\"base\"><freejoint/>" + geom + "<body name=\"a\"><joint/>" + geom +
                           "</body><body name=\"b\"><joint/>" + geom + "</body></body>";
  EXPECT_THAT(message(with_bodies(legs,
                                  "<equality><connect name=\"rod\" body1=\"a\" body2=\"b\" anchor=\"0 0 0\"/>"
                                  "</equality>")),
              HasSubstr("'rod' closes a loop"));
}

TEST(MjcfRobot, IsToldFromAUrdf) {
  EXPECT_TRUE(is_mjcf(kBiped));
  EXPECT_FALSE(is_mjcf("<robot name=\"r\"/>"));
  EXPECT_FALSE(is_mjcf("no xml"));
}

}  // namespace
}  // namespace prowl

#include "prowl/model/robot_model.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <limits>
#include <pinocchio/algorithm/frames.hpp>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/description_error.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/small_robot.hpp"

namespace prowl {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;

std::vector<Eigen::Vector3d> contact_points(const RobotModel& robot, const Eigen::VectorXd& q) {
  const PinocchioModel& pin = robot.pinocchio();
  pinocchio::Data data(pin.model);
  pinocchio::framesForwardKinematics(pin.model, data, q);
  std::vector<Eigen::Vector3d> points;
  for (const auto frame : pin.contact_frames) points.push_back(data.oMf[frame].translation());
  return points;
}

template <class Exception = InputError>
std::string message_for(RobotDescription description) {
  try {
    RobotModel robot(std::move(description));
  } catch (const Exception& error) {
    return error.what();
  }
  return "accepted";
}

TEST(RobotModel, LoadsTheFiveRobots) {
  struct Expected {
    RobotModel robot;
    double mass;  // [kg], by Pinocchio in Python
    int joints;
  };
  const Expected robots[] = {{test::hyq(), 86.774, 12},
                             {test::anymal_c(), 52.135, 12},
                             {test::solo12(), 2.500, 12},
                             {test::go2(), 16.085, 12},
                             {test::talos(), 90.27, 32}};
  for (const auto& [robot, mass, joints] : robots) {
    SCOPED_TRACE(robot.name());
    EXPECT_NEAR(robot.mass(), mass, 5e-3);
    EXPECT_EQ(robot.nu(), joints);
    EXPECT_EQ(robot.nq(), joints + 7);
    EXPECT_EQ(robot.nv(), robot.pinocchio().model.nv);
    EXPECT_EQ(robot.nq(), robot.pinocchio().model.nq);
    for (const auto* limit :
         {&robot.position_lower(), &robot.position_upper(), &robot.velocity_limit(), &robot.torque_limit()}) {
      EXPECT_EQ(limit->size(), joints);
      EXPECT_TRUE(limit->allFinite());
    }
    const Eigen::VectorXd posture = robot.nominal_configuration().tail(joints);
    EXPECT_TRUE((posture.array() >= robot.position_lower().array()).all());
    EXPECT_TRUE((posture.array() <= robot.position_upper().array()).all());
  }
}

TEST(RobotModel, GravityIsTheOneOfPinocchio) {
  const Eigen::Vector3d gravity = test::hyq().pinocchio().model.gravity.linear();
  EXPECT_EQ(gravity, Eigen::Vector3d(0.0, 0.0, -RobotModel::kGravity));
  EXPECT_DOUBLE_EQ(test::hyq().weight(), 9.81 * test::hyq().mass());
}

TEST(RobotModel, JointsAreInPinocchiosOrderWithTheLimitsOfTheUrdf) {
  const RobotModel robot = test::hyq();
  EXPECT_THAT(robot.joint_names(), ElementsAre("lf_haa_joint", "lf_hfe_joint", "lf_kfe_joint", "lh_haa_joint",
                                               "lh_hfe_joint", "lh_kfe_joint", "rf_haa_joint", "rf_hfe_joint",
                                               "rf_kfe_joint", "rh_haa_joint", "rh_hfe_joint", "rh_kfe_joint"));
  EXPECT_EQ(robot.torque_limit(), Eigen::VectorXd::Constant(12, 150.0));
  EXPECT_EQ(robot.velocity_limit(), Eigen::VectorXd::Constant(12, 12.0));
  EXPECT_NEAR(robot.position_lower()(2), -2.4435, 1e-4);  // lf_kfe_joint
  EXPECT_NEAR(robot.position_upper()(5), 2.4435, 1e-4);   // lh_kfe_joint
  EXPECT_THAT(robot.joint_is_prismatic(), testing::Each(false));
}

TEST(RobotModel, LimitsOfTheRobotReplaceThoseOfTheUrdfOneByOne) {
  RobotDescription description = test::hyq_description();
  description.limits["lf_hfe_joint"].torque = 120.0;
  description.limits["lf_kfe_joint"] = {-2.0, -0.5, 8.0, {}};
  const RobotModel robot(description), plain = test::hyq();
  EXPECT_EQ(robot.torque_limit()(1), 120.0);
  EXPECT_EQ(robot.velocity_limit()(1), 12.0);
  EXPECT_EQ(robot.position_lower()(2), -2.0);
  EXPECT_EQ(robot.position_upper()(2), -0.5);
  EXPECT_EQ(robot.velocity_limit()(2), 8.0);
  EXPECT_EQ(robot.torque_limit()(2), 150.0);
  EXPECT_EQ(robot.torque_limit().tail(10), plain.torque_limit().tail(10));
}

TEST(RobotModel, NominalPostureStandsOnTheGroundAboveTheOrigin) {
  for (const RobotModel& robot : {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}) {
    SCOPED_TRACE(robot.name());
    const auto points = contact_points(robot, robot.nominal_configuration());
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    double lowest = std::numeric_limits<double>::infinity();
    for (std::size_t c = 0; c < points.size(); ++c) {
      mean += points[c] / static_cast<double>(points.size());
      lowest = std::min(lowest, points[c].z() - robot.contacts()[c].radius);
    }
    EXPECT_NEAR(lowest, 0.0, 1e-12);
    EXPECT_NEAR(mean.head<2>().norm(), 0.0, 1e-12);
    EXPECT_GT(base_position(robot.nominal_configuration()).z(), 0.2);
  }
  // HyQ's SRDF has its feet at z = 0 for a base at 0.5775 m; ours stands one foot radius higher.
  EXPECT_NEAR(test::hyq().nominal_configuration()(2), 0.5775 + 0.02175, 1e-4);
}

TEST(RobotModel, TheLowestContactTouchesEvenIfTheBaseIsTilted) {
  RobotDescription description = test::hyq_description();
  description.nominal_base_rpy = {0.0, 0.3, 0.0};  // nose down
  const RobotModel robot(description);
  const auto points = contact_points(robot, robot.nominal_configuration());
  EXPECT_NEAR(points[0].z(), 0.02175, 1e-9);  // lf
  EXPECT_GT(points[1].z(), 0.1);              // lh
}

TEST(RobotModel, ContactsMayBeOffsetFromTheirFrame) {
  RobotDescription description = test::hyq_description();
  const RobotModel plain(description);
  description.contacts[0].offset = {0.01, -0.02, 0.03};
  const RobotModel robot(description);
  const Eigen::VectorXd& q = plain.nominal_configuration();
  const auto points = contact_points(robot, q);
  const auto plain_points = contact_points(plain, q);
  EXPECT_NEAR((points[0] - plain_points[0]).norm(), description.contacts[0].offset.norm(), 1e-14);
  EXPECT_EQ(points[1], plain_points[1]);

  const auto& model = plain.pinocchio().model;
  pinocchio::Data data(model);
  pinocchio::framesForwardKinematics(model, data, q);
  const Eigen::Vector3d expected = data.oMf[model.getFrameId("lf_foot")].act(description.contacts[0].offset);
  EXPECT_LT((points[0] - expected).norm(), 1e-14);
}

/// They are frames of Pinocchio's, but none of the robot's.
TEST(RobotModel, ContactsAreOnFramesOfTheRobot) {
  for (const char* frame : {"universe", "root_joint", "lf_hfe_joint"}) {
    RobotDescription description = test::hyq_description();
    description.contacts[0].frame = frame;
    EXPECT_THAT(message_for(description), HasSubstr(std::string("frame '") + frame + "' is not a link or fixed joint"));
  }
}

TEST(RobotModel, ContactsPreferALinkToAFixedJointOfItsName) {
  const test::TemporaryFolder folder;
  const std::string urdf = test::replaced(test::small_urdf(), "joint name=\"right_ankle\"", "joint name=\"left_foot\"");
  const RobotModel robot(test::small_description(folder.write("robot.urdf", urdf)));
  const auto points = contact_points(robot, robot.nominal_configuration());
  EXPECT_GT(points[0].y(), 0.05) << "the joint is on the right";
}

TEST(RobotModel, CopiesAreEqualAndIndependent) {
  const RobotModel original = test::hyq();
  RobotModel copy = test::solo12();
  copy = original;
  EXPECT_EQ(copy.name(), "HyQ");
  EXPECT_EQ(copy.nominal_configuration(), original.nominal_configuration());
  EXPECT_EQ(copy.torque_limit(), original.torque_limit());
  EXPECT_EQ(copy.joint_names(), original.joint_names());
  EXPECT_NE(&copy.pinocchio(), &original.pinocchio());
  EXPECT_EQ(copy.pinocchio().contact_frames, original.pinocchio().contact_frames);
}

TEST(RobotModel, WrongNamesAreAnsweredWithTheNearestRightOne) {
  RobotDescription robot = test::hyq_description();
  robot.contacts[0].frame = "lf_fot";
  EXPECT_THAT(message_for(robot), HasSubstr("contact 'lf_foot': frame 'lf_fot' is not a link"));
  EXPECT_THAT(message_for(robot), HasSubstr("did you mean 'lf_foot'?"));

  robot = test::hyq_description();
  robot.nominal_joints["lf_hfe"] = 0.1;
  EXPECT_THAT(message_for(robot), HasSubstr("nominal.joints: 'lf_hfe' is not a joint"));
  EXPECT_THAT(message_for(robot), HasSubstr("did you mean 'lf_hfe_joint'?"));

  robot = test::hyq_description();
  robot.limits["rh_kfe_jiont"].torque = 100.0;
  EXPECT_THAT(message_for(robot), HasSubstr("limits: 'rh_kfe_jiont' is not a joint"));
  EXPECT_THAT(message_for(robot), HasSubstr("did you mean 'rh_kfe_joint'?"));

  try {
    test::hyq().contact_index("lf_hand");
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("'lf_hand' is not a contact of robot 'HyQ'; did you mean 'lf_foot'?"));
  }
  EXPECT_EQ(test::hyq().contact_index("rf_foot"), 2);
}

TEST(RobotModel, RefusesContactsPosturesAndLimitsThatCannotBe) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto changed = [](auto change) {
    RobotDescription robot = test::hyq_description();
    change(robot);
    return message_for(robot);
  };
  EXPECT_THAT(changed([](auto& r) { r.contacts[1].name = "lf_foot"; }), HasSubstr("'lf_foot': the name"));
  EXPECT_THAT(changed([](auto& r) { r.contacts[0].radius = -0.01; }), HasSubstr("radius -0.01"));
  EXPECT_THAT(changed([=](auto& r) { r.contacts[0].radius = nan; }), HasSubstr("radius nan"));
  EXPECT_THAT(changed([=](auto& r) { r.contacts[0].offset.x() = nan; }), HasSubstr("offset"));
  EXPECT_THAT(changed([=](auto& r) { r.nominal_joints["lf_hfe_joint"] = nan; }), HasSubstr("lf_hfe_joint: nan"));
  EXPECT_THAT(changed([=](auto& r) { r.nominal_base_rpy.y() = nan; }), HasSubstr("base_rpy"));
  EXPECT_THAT(changed([](auto& r) { r.limits["lf_hfe_joint"].torque = 0.0; }), HasSubstr("'lf_hfe_joint': torque"));
  EXPECT_THAT(changed([=](auto& r) { r.limits["lf_hfe_joint"].velocity = nan; }), HasSubstr("velocity limit nan"));
  EXPECT_THAT(changed([](auto& r) { r.limits["lf_hfe_joint"].position_lower = 2.0; }), HasSubstr("lower < upper"));
}

TEST(RobotModel, RefusesFilesThatCannotBeReadOrAreNoRobot) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(message_for<FileError>(test::small_description("/no/such/robot.urdf")),
              HasSubstr("/no/such/robot.urdf: cannot be read"));
  const std::filesystem::path pipe = folder.write("pipe", "");
  std::filesystem::remove(pipe);
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(message_for<FileError>(test::small_description(pipe)), HasSubstr("cannot be read"))
      << "nobody writes to it";
  EXPECT_THAT(message_for(test::small_description(folder.write("a.urdf", "[robot]"))), HasSubstr("not an XML file"));
  EXPECT_THAT(message_for(test::small_description(folder.write("b.urdf", "<sdf/>"))), HasSubstr("not a URDF"));
  EXPECT_EQ(message_for(test::small_description(folder.write("c.urdf", test::small_urdf()))), "accepted");
}

TEST(RobotModel, RefusesBodiesAndLimitsThatCannotBe) {
  const test::TemporaryFolder folder;
  const auto message = [&](const std::string& from, const std::string& to) {
    return message_for(test::small_description(folder.write("r.urdf", test::replaced(test::small_urdf(), from, to))));
  };
  EXPECT_THAT(message("mass value=\"1\"", "mass value=\"0\""), HasSubstr("joint 'left_hip' (links left_leg"));
  EXPECT_THAT(message("mass value=\"1\"", "mass value=\"0\""), HasSubstr("expected mass > 0"));
  EXPECT_THAT(message("izz=\"0.001\"", "izz=\"-0.001\""), HasSubstr("expected all > 0"));
  EXPECT_THAT(message("izz=\"0.001\"", "izz=\"0.05\""), HasSubstr("triangle inequality"));
  EXPECT_THAT(message("effort=\"50\"", "effort=\"0\""), HasSubstr("'left_hip': torque limit (effort) 0"));
  EXPECT_THAT(message("velocity=\"10\"", "velocity=\"-10\""), HasSubstr("velocity=\"-10\""));
  EXPECT_THAT(message("velocity=\"10\"", "velocity=\"0\""), HasSubstr("'left_hip': velocity limit 0"));
  EXPECT_THAT(message("lower=\"-0.5\"", "lower=\"1.6\""), HasSubstr("position from 1.6 to 1.5"));
  EXPECT_THAT(message("mass value=\"1\"", "mass value=\"nan\""), HasSubstr("\"nan\""));
}

/// The robot file's, if it is that which replaces what cannot be.
TEST(RobotModel, SaysWhichKeyIsToBlame) {
  RobotDescription robot = test::small_description("/nowhere/small.urdf");
  robot.urdf_text = test::replaced(test::small_urdf(), "effort=\"50\"", "effort=\"0\"");
  const auto key = [&] {
    try {
      RobotModel{robot};
    } catch (const DescriptionError& error) {
      return error.key();
    }
    return std::string("none");
  };
  EXPECT_EQ(key(), "urdf");
  robot.limits["left_hip"].velocity = 5.0;
  EXPECT_EQ(key(), "urdf") << "that replaces another limit";
  robot.limits["left_hip"].torque = 0.0;
  EXPECT_EQ(key(), "limits.left_hip");
  robot.limits["left_hip"].torque = 10.0;
  EXPECT_EQ(key(), "none");
  robot.nominal_joints["hip"] = 0.0;
  EXPECT_EQ(key(), "nominal.joints.hip");
  robot.contacts.push_back({"toe", "nothing"});
  EXPECT_EQ(key(), "contact[" + std::to_string(robot.contacts.size() - 1) + "].frame");
}

TEST(RobotModel, TextStandsForTheFile) {
  RobotDescription robot = test::small_description("/nowhere/small.urdf");
  EXPECT_THAT(message_for<FileError>(robot), HasSubstr("/nowhere/small.urdf: cannot be read"));
  robot.urdf_text = test::small_urdf();
  EXPECT_EQ(RobotModel(robot).nu(), 2);
  const test::TemporaryFolder folder;
  const RobotModel from_file(test::small_description(folder.write("small.urdf", test::small_urdf())));
  EXPECT_EQ(from_file.description().urdf_text, test::small_urdf());
}

TEST(RobotModel, MostJointsThatAreAllowedFitIntoMemory) {
  RobotDescription robot;
  robot.name = "chain";
  robot.urdf_text = test::chain_urdf(120);
  robot.contacts = {{"tip", "l120"}};
  const RobotModel model(robot);
  EXPECT_EQ(model.nu(), 120);
  EXPECT_EQ(contact_points(model, model.nominal_configuration()).size(), 1u);
  rusage usage;
  ASSERT_EQ(getrusage(RUSAGE_SELF, &usage), 0);
  EXPECT_LT(usage.ru_maxrss, 500'000) << "kB; four tensors of nv³ numbers are 64 MB";
}

TEST(RobotModel, MasslessLinksAreFineWhereFixedJointsMergeThem) {
  const RobotModel robot = test::hyq();  // base_link: 1e-6 kg; feet frames without inertia
  const auto& links = robot.pinocchio().urdf.links;
  const auto base = std::find_if(links.begin(), links.end(), [](const UrdfLink& l) { return l.name == "base_link"; });
  ASSERT_NE(base, links.end());
  EXPECT_LT(base->mass, 1e-5);
}

/// A small robot whose left leg hangs on a second joint about another axis, at the same point.
std::string two_axes(const std::string& inertial, const std::string& axis) {
  std::string xml = test::replaced(test::small_urdf(), "<child link=\"left_leg\"/>", "<child link=\"left_cross\"/>");
  const std::string limit = "<limit lower=\"-1\" upper=\"1\" velocity=\"10\" effort=\"50\"/></joint>";
  return test::replaced(xml, "</robot>",
                        "<link name=\"left_cross\">" + inertial +
                            "</link><joint name=\"left_pitch\" type=\"revolute\"><parent link=\"left_cross\"/>"
                            "<child link=\"left_leg\"/><axis xyz=\"" +
                            axis + "\"/>" + limit + "</robot>");
}

std::string inertial(const char* mass, const char* moment) {
  return fmt::format(
      "<inertial><mass value=\"{}\"/><inertia ixx=\"{}\" ixy=\"0\" ixz=\"0\" iyy=\"{}\" iyz=\"0\" "
      "izz=\"{}\"/></inertial>",
      mass, moment, moment, moment);
}

/// iCub's and many humanoids' hips: the body between two axes has no inertia of its own.
TEST(RobotModel, ABodyWithoutInertiaMayCarryOthers) {
  RobotDescription robot = test::small_description("/nowhere/small.urdf");
  const auto message = [&](const std::string& own, const std::string& axis) {
    robot.urdf_text = two_axes(own, axis);
    return message_for(robot);
  };
  EXPECT_EQ(message("", "0 1 0"), "accepted");
  EXPECT_EQ(message(inertial("0.7", "0"), "0 1 0"), "accepted");
  EXPECT_THAT(message("", "1 0 0"), HasSubstr("joint 'left_pitch' moves a body that has no inertia"))
      << "two axes are one: their difference moves nothing";
  EXPECT_EQ(massless_joints(robot), std::vector<std::string>{"left_pitch"});
  robot.locked_joints = {"left_pitch"};
  EXPECT_EQ(message_for(robot), "accepted");
  robot.locked_joints.clear();
  EXPECT_THAT(message(inertial("0.7", "-1e-3"), "0 1 0"), HasSubstr("expected all > 0"));
  EXPECT_THAT(message(inertial("0", "1e-3"), "0 1 0"), HasSubstr("the mass is 0 kg"));
}

TEST(RobotModel, LockedJointsAreFixedAtTheirNominalPosition) {
  RobotDescription robot = test::small_description("/nowhere/small.urdf");
  robot.urdf_text = test::small_urdf();
  robot.nominal_joints["left_hip"] = 0.4;
  robot.nominal_joints["right_hip"] = -0.2;
  const RobotModel moving(robot);
  robot.locked_joints = {"left_hip"};
  const RobotModel locked(robot);
  EXPECT_EQ(locked.joint_names(), std::vector<std::string>{"right_hip"});
  EXPECT_DOUBLE_EQ(locked.mass(), moving.mass());
  const auto points = contact_points(moving, moving.nominal_configuration());
  const auto locked_points = contact_points(locked, locked.nominal_configuration());
  for (std::size_t c = 0; c < points.size(); ++c) EXPECT_LT((points[c] - locked_points[c]).norm(), 1e-12);
  robot.locked_joints = {"left_hop"};
  EXPECT_THAT(message_for(robot), AllOf(HasSubstr("'left_hop' is not a moving joint"), HasSubstr("left_hip")));
}

TEST(RobotModel, ArmatureIsOnTheDiagonalOfTheMassMatrix) {
  RobotDescription description = test::small_description("/nowhere/small.urdf");
  description.urdf_text = test::small_urdf();
  const RobotModel without(description);
  description.armature["left_hip"] = 0.03;
  const RobotModel with(description);
  EXPECT_EQ(with.armature()(0), with.joint_names()[0] == "left_hip" ? 0.03 : 0.0);
  EXPECT_DOUBLE_EQ(with.armature().sum(), 0.03);
  EXPECT_DOUBLE_EQ(with.mass(), without.mass());
  description.armature = {{"left_hop", 0.03}};
  EXPECT_THAT(message_for(description), AllOf(HasSubstr("'left_hop' is not a joint"), HasSubstr("left_hip")));
  description.armature = {{"left_hip", -0.03}};
  EXPECT_THAT(message_for(description), HasSubstr("armature.left_hip: -0.03 is not allowed; need >= 0"));
  description.armature = {{"left_hip", 0.03}};
  description.locked_joints = {"left_hip"};
  EXPECT_DOUBLE_EQ(RobotModel(description).armature().sum(), 0.0);
}

TEST(RobotModel, TakesDampingAndDryFrictionFromTheUrdf) {
  EXPECT_FALSE(test::go2().losses().damping.any() || test::go2().losses().dry_friction.any());
  EXPECT_TRUE((test::hyq().losses().damping.array() == 0.1).all());
  RobotDescription description = test::talos_description();
  const RobotModel talos(description);
  const auto index = [](const RobotModel& robot, const std::string& joint) {
    return std::ranges::find(robot.joint_names(), joint) - robot.joint_names().begin();
  };
  EXPECT_EQ(talos.losses().dry_friction(index(talos, "torso_1_joint")), 1.0);
  description.locked_joints.push_back("torso_1_joint");
  const RobotModel locked(description);
  ASSERT_EQ(locked.losses().damping.size(), locked.nu());
  for (const std::string& joint : locked.joint_names()) {
    EXPECT_EQ(locked.losses().damping(index(locked, joint)), talos.losses().damping(index(talos, joint))) << joint;
    EXPECT_EQ(locked.losses().dry_friction(index(locked, joint)), talos.losses().dry_friction(index(talos, joint)))
        << joint;
  }
}

TEST(RobotModel, JointsThatCopyOthersAreLockedUnlessTheyCarryAContact) {
  RobotDescription robot = test::small_description("/nowhere/small.urdf");
  const std::string axis = "<axis xyz=\"1 0 0\"/>";
  robot.urdf_text = test::replaced(test::small_urdf(), axis, axis + "<mimic joint=\"right_hip\"/>");
  EXPECT_THAT(message_for(robot), HasSubstr("contact 'left_foot': it moves with joint 'left_hip', which copies"));
  robot.contacts.erase(robot.contacts.begin());
  EXPECT_EQ(RobotModel(robot).joint_names(), std::vector<std::string>{"right_hip"});
}

}  // namespace
}  // namespace prowl

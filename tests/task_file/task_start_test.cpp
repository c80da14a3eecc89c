// A start that moves, or that stands nearly on its contacts.
#include <gmock/gmock.h>

#include <limits>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/task_test.hpp"

namespace prowl {
namespace {

using test::kTaskFile;
using testing::HasSubstr;
using testing::MatchesRegex;

class TaskStart : public test::TaskTest {
 protected:
  static std::string with_start(const std::string& lines) {
    return test::replaced(kTaskFile, "[start]", "[start]\n" + lines);
  }
  std::string message(const std::string& lines) { return message_of(with_start(lines)); }

  static Eigen::VectorXd slip(const MotionProblem& problem) {
    RigidBodyTerms terms(problem.robot);
    terms.update_kinematics(problem.start_configuration());
    ContactKinematics contacts(contact_indices(problem.phases[0].contacts));
    contacts.set_configuration(terms);
    return contacts.jacobian() * problem.start().velocity_lower;
  }
};

TEST_F(TaskStart, JointRatesFollowFromTheBase) {
  const MotionProblem problem =
      read(with_start("base_linear_velocity_mps = [0.3, -0.1, 0.2]\nbase_angular_velocity_radps = [0.1, 0.5, -0.3]"))
          .problem;
  const Eigen::VectorXd& v = problem.start().velocity_lower;
  EXPECT_EQ(problem.start().velocity_upper, v);
  EXPECT_EQ(v.head<3>(), Eigen::Vector3d(0.3, -0.1, 0.2));
  EXPECT_EQ(v.segment<3>(3), Eigen::Vector3d(0.1, 0.5, -0.3));
  EXPECT_GT(v.tail(12).norm(), 0.1);
  EXPECT_LT(slip(problem).norm(), 1e-9);
}

TEST_F(TaskStart, JointRatesOfTheFileAreCorrectedWhereTheContactsNearlyStand) {
  const MotionProblem problem = read(with_start("joint_velocity_radps = { lf_kfe_joint = 0.05 }")).problem;
  EXPECT_LT(problem.start().velocity_lower.norm(), 1e-9) << "a leg that stands cannot move alone";
  EXPECT_THAT(message("joint_velocity_radps = { lf_kfe_joint = 1 }"),
              MatchesRegex("task.toml:12:24: start.joint_velocity_radps: the contacts of the first phase move at up to "
                           "0\\.[0-9]+ m/s; need at most 0.05 m/s, which the joints correct, or no joint rates: these "
                           "then follow from the base"));
}

TEST_F(TaskStart, LeavesPartsToTheOptimiser) {
  const MotionProblem problem = read(with_start("base_position_m = [0, [-0.1, 0.2], 0.6]\n"
                                                "base_rpy_rad = [0, \"free\", [-0.3, 0.1]]\n"
                                                "base_linear_velocity_mps = [0.1, 0, 0]\n"
                                                "joint_velocity_radps = { lf_kfe_joint = [-1, 2] }"))
                                    .problem;
  const RobotModel& robot = problem.robot;
  const BoundaryConstraint& start = problem.start();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const double lower[] = {0.0, -0.1, 0.0, 0.0, -kInfinity, -0.3}, upper[] = {0.0, 0.2, 0.0, 0.0, kInfinity, 0.1};
  for (int i = 0; i < 6; ++i) {
    EXPECT_DOUBLE_EQ(start.configuration_lower(i), lower[i]);
    EXPECT_DOUBLE_EQ(start.configuration_upper(i), upper[i]);
  }
  // The legs follow; the file names their first joints.
  for (int j = 0; j < 12; ++j) {
    const bool is_named = robot.joint_names()[j].ends_with("_haa_joint");
    const double q = start.q_ref(7 + j), limit = is_named ? q : robot.position_lower()(j);
    EXPECT_DOUBLE_EQ(start.configuration_lower(6 + j), limit - q) << robot.joint_names()[j];
  }
  EXPECT_EQ(start.velocity_lower.head<6>(), start.velocity_upper.head<6>());
  EXPECT_EQ(start.velocity_lower(8), -1.0);
  EXPECT_EQ(start.velocity_upper(8), 2.0);
  EXPECT_EQ(start.velocity_upper(9), robot.velocity_limit()(3)) << "the other rates follow from the base";
}

TEST_F(TaskStart, ContactsStayWhereTheFixedPartsPutThem) {
  const MotionProblem fixed = read(kTaskFile).problem;
  const MotionProblem open = read(with_start("base_position_m = [[0, 0.1], 0, \"free\"]")).problem;
  EXPECT_TRUE(open.start_configuration().isApprox(fixed.start_configuration(), 1e-12));
  EXPECT_FALSE(open.start().fixes_configuration());
  EXPECT_TRUE(open.start().fixes_velocity());
}

TEST_F(TaskStart, ArmsDoNotFollow) {
  const Task task = read_task_file(std::string(PROWL_SOURCE_DIR) + "/tasks/talos/squat.toml", test::test_search());
  std::string text = test::replaced(task.task_file.text, "../..", PROWL_SOURCE_DIR);
  text.insert(text.find("[[phase]]"), "[start]\nbase_position_m = [0, 0, \"free\"]\n");
  const MotionProblem problem = read(text).problem;
  for (int j = 0; j < problem.robot.nu(); ++j) {
    const bool is_leg = problem.robot.joint_names()[j].starts_with("leg_");
    EXPECT_EQ(problem.start().configuration_upper(6 + j) > 0.0, is_leg) << problem.robot.joint_names()[j];
  }
}

TEST_F(TaskStart, RefusesRangesOutsideTheLimitsOfAJoint) {
  EXPECT_THAT(message("joint_velocity_radps = { lf_kfe_joint = [13, 14] }"),
              HasSubstr("task.toml:12:41: start.joint_velocity_radps.lf_kfe_joint: outside the joint's limits; need "
                        "some part of [-12, 12]"));
  EXPECT_THAT(message("base_position_m = [0, 0, [0.6, 0.5]]"), HasSubstr("need [min, max] with min <= max"));
  EXPECT_THAT(message("base_position_m = [0, 0, \"low\"]"), HasSubstr("need a finite number, [min, max] or \"free\""));
}

TEST_F(TaskStart, RefusesRatesBeyondTheLimitsOfAJoint) {
  EXPECT_THAT(message("base_linear_velocity_mps = [9, 0, 0]"),
              MatchesRegex("task.toml:11:1: start: [a-z_]+ turns at -?[0-9.]+ rad/s, beyond its limit of 12 rad/s"));
  EXPECT_THAT(message("base_linear_velocity_mps = [0, 0]"), HasSubstr("need a list of 3 [m/s]"));
}

TEST_F(TaskStart, JointsPutContactsDownThatAreNearlyOnTheGround) {
  const auto start_at = [&](double height) {
    const double z = base_position(read(kTaskFile).problem.start_configuration()).z() + height;
    return with_start("base_position_m = [0, 0, " + std::to_string(z) + "]");
  };
  const MotionProblem problem = read(start_at(0.008)).problem;
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  for (const PhaseContact& held : problem.phases[0].contacts) {
    const double gap = terms.contact_position(held.contact).z() - problem.robot.contacts()[held.contact].radius;
    EXPECT_LT(std::abs(gap), 1e-6);
  }
  EXPECT_THAT(message_of(start_at(0.02)), HasSubstr(" mm above surface 'floor'"));
}

}  // namespace
}  // namespace prowl

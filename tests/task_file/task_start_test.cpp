// A start that moves, or that stands nearly on its contacts.
#include <gmock/gmock.h>

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

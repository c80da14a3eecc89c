#include "prowl/dynamics/body_bounds.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

std::vector<RobotModel> robots() { return {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}; }

Vector3d centre_of_mass(const RobotModel& robot, const Eigen::VectorXd& q) {
  RigidBodyTerms terms(robot);
  const Eigen::VectorXd rest = Eigen::VectorXd::Zero(robot.nv());
  terms.update_with_derivatives(q, rest, rest);
  const Eigen::Matrix3d moment = terms.mass_matrix().block<3, 3>(0, 3) / robot.mass();
  return {moment(1, 2), moment(2, 0), moment(0, 1)};  // base frame
}

TEST(BodyBounds, HoldInAnyPosture) {
  for (const RobotModel& robot : robots()) {
    test::RandomStates states(robot, 11);
    const MassReach mass = mass_reach(robot);
    for (int i = 0; i < 200; ++i) {
      const Eigen::VectorXd q = states.configuration();
      RigidBodyTerms terms(robot);
      terms.update_kinematics(q);
      for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) {
        const ContactReach leg = contact_reach(robot, c);
        const Vector3d p = base_rotation(q).transpose() * (terms.contact_position(c) - base_position(q));
        EXPECT_LE((p - leg.root).norm(), leg.length + 1e-9) << robot.name();
      }
      EXPECT_LE((centre_of_mass(robot, q) - mass.centre).norm(), mass.radius) << robot.name();
    }
  }
}

// A bound that is far too large would hold as well.
TEST(BodyBounds, AreNearlyReachedByAStraightLeg) {
  for (const RobotModel& robot : {test::hyq(), test::solo12()}) {
    Eigen::VectorXd q = robot.nominal_configuration();
    q.tail(robot.nu()).setZero();
    RigidBodyTerms terms(robot);
    terms.update_kinematics(q);
    const ContactReach leg = contact_reach(robot, 0);
    const double straight = (base_rotation(q).transpose() * (terms.contact_position(0) - base_position(q)) - leg.root).norm();
    EXPECT_GT(straight, 0.85 * leg.length);
  }
  EXPECT_LT(mass_reach(test::hyq()).radius, 0.15) << "most of HyQ's mass is in its trunk";
}

TEST(BodyBounds, NameTheFirstJointOfALeg) {
  const RobotModel robot = test::hyq();
  EXPECT_EQ(robot.joint_names()[static_cast<std::size_t>(contact_reach(robot, robot.contact_index("rf_foot")).first_joint)],
            "rf_haa_joint");
}

TEST(BodyBounds, OfAContactOnTheBaseAreItsPlace) {
  RobotDescription description = test::hyq_description();
  description.contacts.push_back({"belly", "trunk", 0.0, {0.1, 0.2, -0.3}});
  const RobotModel robot(description);
  const ContactReach belly = contact_reach(robot, robot.contact_index("belly"));
  EXPECT_EQ(belly.first_joint, -1);
  EXPECT_EQ(belly.length, 0.0);
  EXPECT_NEAR((belly.root - Vector3d(0.1, 0.2, -0.3)).norm(), 0.0, 1e-12);
}

}  // namespace
}  // namespace prowl

#include "prowl/dynamics/body_bounds.hpp"

#include <gtest/gtest.h>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/leg_kinematics.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/random_vector.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;

std::vector<RobotModel> robots() { return {test::hyq(), test::anymal_c(), test::solo12(), test::go2(), test::talos()}; }

// The weight turns the robot about its base by its lever.
TEST(CentreOfMass, IsWhereTheWeightActs) {
  for (const RobotModel& robot : robots()) {
    test::RandomStates states(robot, 5);
    const Eigen::VectorXd q = states.configuration(), rest = Eigen::VectorXd::Zero(robot.nv());
    RigidBodyTerms terms(robot);
    terms.update(q, rest, rest);
    const Vector3d lever = centre_of_mass(robot, q, rest).position - base_position(q);
    const Vector3d moment = base_rotation(q) * terms.inverse_dynamics().segment<3>(3);
    EXPECT_LT((lever.cross(Vector3d(0.0, 0.0, robot.weight())) - moment).norm(), 1e-9 * robot.weight());
    EXPECT_GT(moment.norm(), 1e-3 * robot.weight()) << "the moment says nothing";
  }
}

TEST(CentreOfMass, MovesAtItsVelocity) {
  for (const RobotModel& robot : robots()) {
    test::RandomStates states(robot, 6);
    const Eigen::VectorXd q = states.configuration(), v = states.velocity();
    const double step = 1e-6;
    Eigen::VectorXd tangent = v;
    tangent.head<3>() = base_rotation(q) * v.head<3>();
    const Vector3d ahead = centre_of_mass(robot, integrate(q, step * tangent), v).position;
    const Vector3d behind = centre_of_mass(robot, integrate(q, -step * tangent), v).position;
    EXPECT_LT((centre_of_mass(robot, q, v).velocity - (ahead - behind) / (2.0 * step)).norm(), 1e-6);
  }
}

/// Between points of any two bodies; of two neighbours it is nearly reached.
TEST(LargestDistance, HoldsInAnyPosture) {
  for (const RobotModel& robot : robots()) {
    test::RandomStates states(robot, 8);
    std::mt19937 rng(9);
    RigidBodyTerms terms(robot);
    const int bodies = robot.nu() + 1;
    std::uniform_int_distribution<int> any(0, bodies - 1);
    for (int i = 0; i < 300; ++i) {
      terms.update_kinematics(states.configuration());
      const BodyPoint a{.body = any(rng), .in_body = test::random_vector(rng, 3, 0.1)},
          b{.body = any(rng), .in_body = test::random_vector(rng, 3, 0.1)};
      const auto place = [&](const BodyPoint& point) -> Vector3d {
        return terms.body_rotation(point.body) * point.in_body + terms.body_position(point.body);
      };
      const double distance = (place(a) - place(b)).norm(), bound = largest_distance(robot, a, b);
      EXPECT_LE(distance, bound + 1e-9) << robot.name();
      EXPECT_DOUBLE_EQ(bound, largest_distance(robot, b, a));
      if (a.body == b.body) EXPECT_NEAR(distance, bound, 1e-9);
    }
  }
}

TEST(JointLevers, BoundHowFastAJointMovesAContact) {
  for (const RobotModel& robot : robots()) {
    test::RandomStates states(robot, 12);
    LegKinematics legs(robot);
    for (int i = 0; i < 200; ++i) {
      legs.update(states.configuration().tail(robot.nu()));
      for (int c = 0; c < static_cast<int>(robot.contacts().size()); ++c) {
        Eigen::VectorXd bound = Eigen::VectorXd::Zero(robot.nu());
        for (const auto& [joint, length] : joint_levers(robot, c)) bound(joint) = length;
        const Eigen::VectorXd speeds = legs.linear(c).colwise().norm().transpose();
        EXPECT_LE((speeds - bound).maxCoeff(), 1e-9) << robot.name();
      }
    }
  }
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
      const Vector3d c = centre_of_mass(robot, q, Eigen::VectorXd::Zero(robot.nv())).position - base_position(q);
      EXPECT_LE((base_rotation(q).transpose() * c - mass.centre).norm(), mass.radius) << robot.name();
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
    const double straight =
        (base_rotation(q).transpose() * (terms.contact_position(0) - base_position(q)) - leg.root).norm();
    EXPECT_GT(straight, 0.85 * leg.length);
  }
  EXPECT_LT(mass_reach(test::hyq()).radius, 0.15) << "most of HyQ's mass is in its trunk";
}

TEST(BodyBounds, NameTheFirstJointOfALeg) {
  const RobotModel robot = test::hyq();
  EXPECT_EQ(robot.joint_names()[contact_reach(robot, robot.contact_index("rf_foot")).first_joint], "rf_haa_joint");
}

TEST(BodyBounds, OfAContactOnTheBaseAreItsPosition) {
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

#include "prowl/dynamics/static_equilibrium.hpp"

#include <gtest/gtest.h>

#include <numeric>
#include <pinocchio/algorithm/center-of-mass.hpp>
#include <random>

#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

std::vector<int> all_contacts(const RobotModel& robot) {
  std::vector<int> contacts(robot.contacts().size());
  std::iota(contacts.begin(), contacts.end(), 0);
  return contacts;
}

/// The nominal posture, tilted and disturbed: nothing symmetric is left.
VectorXd disturbed_posture(const RobotModel& robot) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-0.2, 0.2);
  return integrate(robot.nominal_configuration(), VectorXd::NullaryExpr(robot.nv(), [&] { return uniform(random); }));
}

double height_of_mass(const RobotModel& robot, const VectorXd& q) {
  pinocchio::Data data(robot.pinocchio().model);
  return pinocchio::centerOfMass(robot.pinocchio().model, data, q).z();
}

VectorXd contact_positions(const RobotModel& robot, const VectorXd& q) {
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  VectorXd positions(3 * static_cast<Eigen::Index>(robot.contacts().size()));
  for (const int c : all_contacts(robot)) positions.segment<3>(3 * c) = terms.contact_position(c);
  return positions;
}

class StaticEquilibriumOf : public testing::TestWithParam<RobotDescription> {};

TEST_P(StaticEquilibriumOf, DoesNoWorkInAnySmallMotion) {
  const RobotModel robot(GetParam());
  const VectorXd q = disturbed_posture(robot);
  const StaticEquilibrium rest = static_equilibrium(robot, q, all_contacts(robot));
  EXPECT_LT(rest.residual, 1e-9 * robot.weight());

  // Virtual work: m g dz_com = tau . d_joints + sum f . dp, along every direction, the base's six included.
  const double step = 1e-5;
  for (int i = 0; i < robot.nv(); ++i) {
    const VectorXd direction = VectorXd::Unit(robot.nv(), i);
    const VectorXd ahead = integrate(q, step * direction), behind = integrate(q, -step * direction);
    const double against_gravity =
        robot.weight() * (height_of_mass(robot, ahead) - height_of_mass(robot, behind)) / (2.0 * step);
    const double by_contacts =
        rest.force.dot(contact_positions(robot, ahead) - contact_positions(robot, behind)) / (2.0 * step);
    const double by_torques = rest.tau.dot(direction.tail(robot.nu()));
    EXPECT_NEAR(against_gravity, by_torques + by_contacts, 1e-6 * robot.weight()) << "direction " << i;
  }
}

TEST_P(StaticEquilibriumOf, HasForcesOfSmallestNorm) {
  const RobotModel robot(GetParam());
  const VectorXd q = disturbed_posture(robot);
  const VectorXd f = static_equilibrium(robot, q, all_contacts(robot)).force;
  const VectorXd p = contact_positions(robot, q);

  // Two contacts that push against each other along their line change no balance, so the forces have no share in that.
  for (const int i : all_contacts(robot)) {
    for (int j = 0; j < i; ++j) {
      const Eigen::Vector3d line = (p.segment<3>(3 * i) - p.segment<3>(3 * j)).normalized();
      EXPECT_NEAR(line.dot(f.segment<3>(3 * i) - f.segment<3>(3 * j)), 0.0, 1e-9 * robot.weight());
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, StaticEquilibriumOf,
                         testing::Values(test::hyq_description(), test::anymal_c_description(),
                                         test::solo12_description(), test::go2_description(),
                                         test::talos_description()),
                         [](const auto& info) { return info.param.name.substr(0, info.param.name.find(' ')); });

TEST(StaticEquilibrium, SharesTheWeightOfAStandingRobotUpwards) {
  const RobotModel robot = test::hyq();
  const StaticEquilibrium rest = static_equilibrium(robot, robot.nominal_configuration(), all_contacts(robot));
  for (const int c : all_contacts(robot)) {
    EXPECT_NEAR(rest.force(3 * c), 0.0, 1e-6);
    EXPECT_NEAR(rest.force(3 * c + 1), 0.0, 1e-6);
    EXPECT_NEAR(rest.force(3 * c + 2), robot.weight() / 4.0, 0.1 * robot.weight());
  }
}

TEST(StaticEquilibrium, SaysWhatItCannotBalance) {
  const RobotModel robot = test::hyq();
  const VectorXd q = disturbed_posture(robot);
  const auto residual = [&](const std::vector<int>& contacts) {
    return static_equilibrium(robot, q, contacts).residual;
  };
  EXPECT_GE(residual({}), robot.weight());
  const int lf = robot.contact_index("lf_foot"), rh = robot.contact_index("rh_foot");
  EXPECT_GT(residual({lf, rh}), 1e-3 * robot.weight()) << "two point feet carry no moment about their line";
  EXPECT_LT(residual({lf, rh}), residual({lf}));
  EXPECT_LT(residual({lf}), residual({}));
}

TEST(StaticEquilibrium, LeavesInactiveContactsWithoutForce) {
  const RobotModel robot = test::hyq();
  const int lf = robot.contact_index("lf_foot");
  std::vector<int> others = all_contacts(robot);
  std::erase(others, lf);
  const StaticEquilibrium rest = static_equilibrium(robot, robot.nominal_configuration(), others);
  EXPECT_EQ(rest.force.segment<3>(3 * lf).norm(), 0.0);
  EXPECT_GT(rest.force.norm(), 0.5 * robot.weight());
}

}  // namespace
}  // namespace prowl

#include "prowl/simulation/physics.hpp"

#include <gtest/gtest.h>

#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/rnea.hpp>

#include "prowl/model/pinocchio_model.hpp"
#include "tests/support/random_states.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

struct Case {
  const char* name;
  RobotDescription (*description)();
};

void PrintTo(const Case& robot, std::ostream* out) { *out << robot.name; }

class EveryRobot : public testing::TestWithParam<Case> {};

TEST_P(EveryRobot, HasTheMassMatrixAndBiasOfPinocchio) {
  const RobotModel robot(GetParam().description());
  const pinocchio::Model& model = robot.pinocchio().model;
  pinocchio::Data data(model);
  Physics physics(robot, {}, {});
  EXPECT_NEAR(physics.mass(), robot.mass(), 1e-10 * robot.mass());
  test::RandomStates states(robot, 3);
  for (int i = 0; i < 50; ++i) {
    const Eigen::VectorXd q = states.configuration(), v = states.velocity();
    physics.set_state(q, v);
    Eigen::MatrixXd mass = pinocchio::crba(model, data, Eigen::Ref<const Eigen::VectorXd>(q));
    mass.triangularView<Eigen::StrictlyLower>() = mass.transpose().triangularView<Eigen::StrictlyLower>();
    EXPECT_LT((physics.mass_matrix() - mass).lpNorm<Eigen::Infinity>(), 1e-10 * mass.lpNorm<Eigen::Infinity>());
    const Eigen::VectorXd bias = pinocchio::nonLinearEffects(model, data, q, v);
    EXPECT_LT((physics.bias() - bias).lpNorm<Eigen::Infinity>(), 1e-10 * bias.lpNorm<Eigen::Infinity>());
  }
}

/// In free flight, over a step so short that it is an acceleration.
TEST(Physics, DampsJoints) {
  const RobotModel robot = test::hyq();
  const pinocchio::Model& model = robot.pinocchio().model;
  pinocchio::Data data(model);
  constexpr double kStep = 1e-6;
  Physics physics(robot, {}, {.step = kStep});
  test::RandomStates states(robot, 4);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = states.configuration(), v = states.velocity(), tau = states.torque();
    physics.set_state(q, v);
    Eigen::VectorXd applied = -pinocchio::nonLinearEffects(model, data, q, v);
    applied.tail(robot.nu()) += tau - robot.losses().damping.cwiseProduct(v.tail(robot.nu()));
    Eigen::MatrixXd mass = pinocchio::crba(model, data, Eigen::Ref<const Eigen::VectorXd>(q));
    mass.triangularView<Eigen::StrictlyLower>() = mass.transpose().triangularView<Eigen::StrictlyLower>();
    const Eigen::VectorXd expected = mass.llt().solve(applied).tail(robot.nu());
    ASSERT_TRUE(physics.step(tau));
    const Eigen::VectorXd actual = (physics.v() - v).tail(robot.nu()) / kStep;
    EXPECT_LT((actual - expected).norm(), 1e-4 * expected.norm()) << robot.name();
  }
}

RobotDescription hyq_with_motors() {
  RobotDescription description = test::hyq_description();
  for (const auto& [joint, position] : description.nominal_joints) description.armature[joint] = 0.05 + 0.01 * position;
  return description;
}

INSTANTIATE_TEST_SUITE_P(Shipped, EveryRobot,
                         testing::Values(Case{"HyQWithMotors", hyq_with_motors}, Case{"HyQ", test::hyq_description},
                                         Case{"ANYmalC", test::anymal_c_description},
                                         Case{"Solo12", test::solo12_description}, Case{"Go2", test::go2_description},
                                         Case{"Talos", test::talos_description}),
                         [](const auto& info) { return info.param.name; });

/// The lumped inertia changes by the scale; without contact the robot falls freely, whatever its mass.
TEST(Physics, FallsFreely) {
  const RobotModel robot = test::hyq();
  for (const double scale : {1.0, 1.1}) {
    Physics physics(robot, {}, {.step = 1e-3, .mass_scale = scale, .friction = {}});
    EXPECT_NEAR(physics.mass(), scale * robot.mass(), 1e-9);
    const double start = physics.q()(2);
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(physics.step(Eigen::VectorXd::Zero(robot.nu())));
    // Semi-implicit Euler: the sum of g dt² i, i = 1 ... 100.
    EXPECT_NEAR(physics.q()(2) - start, -RobotModel::kGravity * 1e-6 * 5050, 1e-9);
    EXPECT_LT(physics.v().tail(robot.nu()).norm(), 1e-9);
  }
}

/// Impulse over mass is the change of the centre of mass's velocity.
TEST(Physics, APushChangesMomentumByItsImpulse) {
  const RobotModel robot = test::hyq();
  Physics physics(robot, {}, {});
  const Eigen::Vector3d push(70.0, -30.0, 20.0);
  const auto momentum = [&] { return Eigen::Vector3d((physics.mass_matrix() * physics.v()).head<3>()); };
  ASSERT_TRUE(physics.step(Eigen::VectorXd::Zero(robot.nu()), push));
  Eigen::Vector3d expected = physics.step_size() * (push - Eigen::Vector3d(0, 0, robot.weight()));
  EXPECT_LT((base_rotation(physics.q()) * momentum() - expected).norm(), 1e-4 * expected.norm());
}

/// MuJoCo itself would go on from its start.
TEST(Physics, SaysThatAStateIsNoNumber) {
  for (const bool in_torque : {true, false}) {
    const RobotModel robot = test::hyq();
    Physics physics(robot, {Surface{}}, {});
    Eigen::VectorXd tau = Eigen::VectorXd::Zero(robot.nu()), v = Eigen::VectorXd::Zero(robot.nv());
    EXPECT_TRUE(physics.step(tau));
    (in_torque ? tau(3) : v(7)) = std::nan("");
    if (!in_torque) physics.set_state(robot.nominal_configuration(), v);
    EXPECT_FALSE(physics.step(tau)) << in_torque;
  }
}

/// A stiff robot dropped by nothing on the floor: the feet carry its weight.
TEST(Physics, FeetCarryTheWeight) {
  const RobotModel robot = test::hyq();
  Physics physics(robot, {Surface{}}, {});
  const Eigen::VectorXd posture = robot.nominal_configuration();
  for (int i = 0; i < 4000; ++i) {
    const Eigen::VectorXd error = posture.tail(robot.nu()) - physics.q().tail(robot.nu());
    ASSERT_TRUE(physics.step(3000.0 * error - 60.0 * physics.v().tail(robot.nu())));
  }
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const ContactReading& contact : physics.contacts()) {
    EXPECT_TRUE(contact.touches);
    EXPECT_EQ(contact.surface, 0);
    EXPECT_LT(contact.force.head<2>().norm(), 0.5 * contact.force.z());
    EXPECT_LT(contact.slip_velocity.norm(), 1e-4);
    sum += contact.force;
  }
  EXPECT_LT((sum - Eigen::Vector3d(0, 0, robot.weight())).norm(), 1e-3 * robot.weight());
}

/// A block on a slope slides if friction is less than the slope: the surface's coefficient counts, in both ways of a
/// patch.
TEST(Physics, FrictionIsTheSurfacesOwn) {
  const RobotModel robot = test::hyq();
  for (const bool patch : {false, true}) {
    Surface slope{.name = "slope", .normal = Eigen::Vector3d(std::sin(0.2), 0.0, std::cos(0.2)), .friction = 0.0};
    if (patch) slope.patch = {{-2, -2}, {2, -2}, {2, 2}, {-2, 2}};
    for (const double friction : {0.1, 0.4}) {  // tan 0.2 = 0.203
      Physics physics(robot, {slope}, {.step = 5e-4, .mass_scale = 1.0, .friction = friction});
      Eigen::VectorXd q = robot.nominal_configuration();
      const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitY()));
      q.head<3>() = turn * q.head<3>();
      set_base_rotation(q, turn * base_rotation(q));
      physics.set_state(q, Eigen::VectorXd::Zero(robot.nv()));
      for (int i = 0; i < 2000; ++i) {
        const Eigen::VectorXd error = q.tail(robot.nu()) - physics.q().tail(robot.nu());
        ASSERT_TRUE(physics.step(3000.0 * error - 60.0 * physics.v().tail(robot.nu())));
      }
      // Without sticking: g (sin - mu cos) for a second.
      const double free = 0.5 * RobotModel::kGravity * (std::sin(0.2) - friction * std::cos(0.2));
      const double way = (physics.q().head<3>() - q.head<3>()).norm();
      if (friction < 0.2) {
        EXPECT_NEAR(way, free, 0.15 * free) << "patch " << patch;
      } else {
        EXPECT_LT(way, 0.03) << "patch " << patch;
      }
    }
  }
}

}  // namespace
}  // namespace prowl

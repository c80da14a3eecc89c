// The start of a simulation beside that of the plan: the base is elsewhere, and the feet stand on the true ground.
#include "prowl/simulation/start_state.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "prowl/model/configuration.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

class StartState : public testing::TestWithParam<RobotModel (*)()> {};
INSTANTIATE_TEST_SUITE_P(Of, StartState, testing::Values(&test::hyq, &test::solo12, &test::talos));

TEST_P(StartState, KeepsFeetOnTheGroundAndStill) {
  const MotionProblem problem = test::standing_problem(GetParam()());
  const RobotModel& robot = problem.robot;
  std::vector<Surface> ground = problem.surfaces;
  const double tilt = std::numbers::pi / 90.0;
  ground[0].normal = {std::sin(tilt), 0.0, std::cos(tilt)};
  ground[0].point.z() = 0.004;
  Physics physics(robot, ground, {});
  StartError error;
  error.base << 0.008, -0.009, -0.005, 0.015, -0.02, 0.01;
  error.twist << 0.05, -0.03, 0.02, 0.1, -0.05, 0.08;
  error.joints = Eigen::VectorXd::Constant(robot.nu(), 0.01);
  const Eigen::VectorXd& planned = problem.start_configuration();
  const std::vector<Eigen::Vector3d> places = physics.contact_positions(planned);
  Eigen::VectorXd q = planned, v = Eigen::VectorXd::Zero(robot.nv());
  const std::vector<int> holds(robot.contacts().size(), 0);
  displace(physics, ground, holds, error, q, v);

  EXPECT_LT((difference(planned, q).head<6>() - error.base).norm(), 1e-12);
  EXPECT_LT((v.head<6>() - error.twist).norm(), 1e-12);
  const std::vector<Eigen::Vector3d> now = physics.contact_positions(q);
  for (std::size_t c = 0; c < now.size(); ++c) {
    const int contact = static_cast<int>(c);
    EXPECT_NEAR(ground[0].distance(now[c]), physics.contact_radius(contact), 1e-6) << c;
    const Eigen::Vector3d way = now[c] - places[c];
    EXPECT_LT((way - ground[0].normal.dot(way) * ground[0].normal).norm(), 1e-3) << c;
    EXPECT_LT((physics.contact_jacobian(contact) * v).norm(), 1e-9) << c;
  }
}

TEST(StartState, WithoutErrorIsThatOfThePlan) {
  const MotionProblem problem = test::standing_problem();
  Physics physics(problem.robot, problem.surfaces, {});
  Eigen::VectorXd q = problem.start_configuration(), v = Eigen::VectorXd::Zero(problem.robot.nv());
  displace(physics, problem.surfaces, {0, 0, 0, 0}, {}, q, v);
  EXPECT_EQ(q, problem.start_configuration());
  EXPECT_TRUE(v.isZero(0.0));
}

/// Against differences of positions.
TEST(StartState, UsesTheJacobianOfTheContacts) {
  const RobotModel robot = test::hyq();
  Physics physics(robot, {Surface{}}, {});
  Eigen::VectorXd q = robot.nominal_configuration();
  set_base_rotation(q, rotation_from_rpy({0.2, -0.3, 0.4}));
  constexpr double kStep = 1e-6;
  for (Eigen::Index i = 0; i < robot.nv(); ++i) {
    Eigen::VectorXd step = Eigen::VectorXd::Zero(robot.nv());
    step(i) = kStep;
    step.head<3>() = base_rotation(q) * step.head<3>();
    const auto ahead = physics.contact_positions(integrate(q, step)),
               behind = physics.contact_positions(integrate(q, -step));
    physics.contact_positions(q);
    for (int c = 0; c < 4; ++c) {
      const Eigen::Vector3d slope = (ahead[c] - behind[c]) / (2.0 * kStep);
      EXPECT_LT((slope - physics.contact_jacobian(c).col(i)).norm(), 1e-7) << c << " " << i;
    }
  }
}

}  // namespace
}  // namespace prowl

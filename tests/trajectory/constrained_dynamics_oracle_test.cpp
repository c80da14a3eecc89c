#include "prowl/trajectory/constrained_dynamics_oracle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

/// M a - J' f = S' tau - h,  J a = -J̇ v  as one dense system; its solution of least norm, so that f has least norm.
struct DenseSolution {
  Eigen::VectorXd a, force;
};
DenseSolution solve_dense(const RobotModel& robot, const std::vector<int>& contacts, const DynamicsPoint& point) {
  const int nv = robot.nv(), rows = 3 * static_cast<int>(contacts.size());
  RigidBodyTerms terms(robot);
  terms.update_with_derivatives(point.q, point.v, Eigen::VectorXd::Zero(nv));
  ContactKinematics kinematics(contacts);
  kinematics.set_configuration(terms);
  kinematics.set_motion(point.v, Eigen::VectorXd::Zero(nv));

  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(nv + rows, nv + rows);
  matrix.topLeftCorner(nv, nv) = terms.mass_matrix();
  matrix.topRightCorner(nv, rows) = -kinematics.jacobian().transpose();
  matrix.bottomLeftCorner(rows, nv) = kinematics.jacobian();
  Eigen::VectorXd right(nv + rows);
  right << -terms.inverse_dynamics(), -kinematics.acceleration();
  right.segment(6, robot.nu()) += point.tau;
  const Eigen::VectorXd solution = matrix.completeOrthogonalDecomposition().solve(right);
  return {solution.head(nv), solution.tail(rows)};
}

void expect_agreement(const RobotModel& robot, const std::vector<int>& contacts, const DynamicsPoint& point,
                      double force_tolerance) {
  const DenseSolution expected = solve_dense(robot, contacts, point);
  ConstrainedDynamicsOracle oracle(robot, contacts);
  const auto motion = oracle.evaluate(point.q, point.v, point.tau);
  EXPECT_LT(test::relative_error(motion.a, expected.a), 1e-10);
  EXPECT_LT(motion.residual, 1e-6);

  Eigen::VectorXd force = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(robot.contacts().size()));
  for (std::size_t i = 0; i < contacts.size(); ++i) {
    force.segment<3>(3 * contacts[i]) = expected.force.segment<3>(3 * static_cast<Eigen::Index>(i));
  }
  EXPECT_LT(test::relative_error(motion.force, force), force_tolerance);
}

TEST(ConstrainedDynamicsOracle, AgreesWithADenseSolveForAnySetOfContacts) {
  const RobotModel robot = test::hyq();
  for (const std::vector<int>& contacts :
       {std::vector<int>{0, 1, 2, 3}, {0, 1, 3}, {3, 0}, {1, 2}, {2}, std::vector<int>{}}) {
    std::mt19937 rng(11);
    for (int i = 0; i < 50; ++i) {
      SCOPED_TRACE(testing::Message() << contacts.size() << " contacts, sample " << i);
      expect_agreement(robot, contacts, test::random_point(robot, contacts, rng), 1e-8);
    }
  }
}

TEST(ConstrainedDynamicsOracle, TakesRedundantContactsAndFindsTheForcesOfLeastNorm) {
  const RobotModel robot = test::talos();
  const std::vector<int> corners = {0, 1, 2, 3, 4, 5, 6, 7};
  std::mt19937 rng(12);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    DynamicsPoint point = test::random_point(robot, corners, rng);
    point.v.setZero();  // else the corners of one foot ask for different accelerations
    expect_agreement(robot, corners, point, 1e-6);  // forces that move nothing gather rounding
  }
}

TEST(ConstrainedDynamicsOracle, ReportsContactsThatContradictEachOther) {
  const RobotModel robot = test::talos();
  std::mt19937 rng(13);
  const DynamicsPoint point = test::random_point(robot, {0, 1, 2, 3}, rng);  // a turning foot held at four points
  ConstrainedDynamicsOracle oracle(robot, {0, 1, 2, 3});
  EXPECT_GT(oracle.evaluate(point.q, point.v, point.tau).residual, 1e-3);
}

TEST(ConstrainedDynamicsOracle, PassesNaNThrough) {
  const RobotModel robot = test::hyq();
  ConstrainedDynamicsOracle oracle(robot, {0, 1, 2, 3});
  const Eigen::VectorXd nan = Eigen::VectorXd::Constant(robot.nu(), std::nan(""));
  const auto motion = oracle.evaluate(robot.nominal_configuration(), Eigen::VectorXd::Zero(robot.nv()), nan);
  EXPECT_FALSE(motion.a.allFinite());
}

TEST(ConstrainedDynamicsOracle, VelocityOfAContactIsTheRateOfItsPlace) {
  const RobotModel robot = test::talos();  // its contacts have offsets from their frames
  ConstrainedDynamicsOracle oracle(robot, {});
  std::mt19937 rng(14);
  const DynamicsPoint point = test::random_point(robot, {}, rng);
  Eigen::VectorXd step = 1e-6 * point.v;
  step.head<3>() = base_rotation(point.q) * step.head<3>();
  const Eigen::Matrix3Xd before = oracle.contact_points(integrate(point.q, -step), point.v).position;
  const Eigen::Matrix3Xd after = oracle.contact_points(integrate(point.q, step), point.v).position;
  const Eigen::Matrix3Xd velocity = oracle.contact_points(point.q, point.v).velocity;
  EXPECT_GT(velocity.cwiseAbs().maxCoeff(), 0.1);
  EXPECT_LT(test::relative_error((after - before) / 2e-6, velocity), 1e-7);
}

}  // namespace
}  // namespace prowl

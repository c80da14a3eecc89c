#include "prowl/certificate/constrained_dynamics_oracle.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "tests/support/null_space_dynamics.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/random_states.hpp"
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
    expect_agreement(robot, corners, point, 1e-8);
  }
}

/// Worst relative errors of a and f against the null-space solve in random states that the contacts allow.
void expect_null_space_dynamics(const RobotModel& robot, const std::vector<int>& contacts, int rank) {
  ConstrainedDynamicsOracle oracle(robot, contacts);
  test::NullSpaceDynamics reference(robot, contacts);
  test::RandomStates random(robot, 21, 0.5);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(testing::Message() << robot.name() << ", " << contacts.size() << " contacts, sample " << i);
    const Eigen::VectorXd q = random.configuration();
    reference.set_configuration(q);
    if (reference.singular_value_ratio < 1e-3) continue;
    ASSERT_EQ(reference.rank, rank);
    const Eigen::VectorXd v = reference.N * (reference.N.transpose() * random.velocity()), tau = random.torque();
    const Eigen::VectorXd a = reference.solve(v, tau);
    const auto motion = oracle.evaluate(q, v, tau);
    EXPECT_LT(test::relative_error(motion.a, a), 1e-10);
    const Eigen::VectorXd force = reference.pseudo_inverse.transpose() * (reference.M * a - reference.applied);
    Eigen::VectorXd held(force.size());
    for (std::size_t c = 0; c < contacts.size(); ++c) {
      held.segment<3>(3 * static_cast<Eigen::Index>(c)) = motion.force.segment<3>(3 * contacts[c]);
    }
    EXPECT_LT(test::relative_error(held, force), 1e-9);
    EXPECT_LT(motion.residual, 1e-9);
  }
}

TEST(ConstrainedDynamicsOracle, AgreesWithTheNullSpaceAtAnyRank) {
  expect_null_space_dynamics(test::hyq(), {0, 1, 2, 3}, 12);
  expect_null_space_dynamics(test::anymal_c(), {0, 3}, 6);
  expect_null_space_dynamics(test::talos(), {0, 1, 2, 3, 4, 5, 6, 7}, 12);
  expect_null_space_dynamics(test::talos(), {0, 1, 2, 3, 4}, 9);
  expect_null_space_dynamics(test::talos(), {2, 5}, 6);
}

TEST(ConstrainedDynamicsOracle, InternalForcesDoNothingAndLeaveNothingToTheForcesOfLeastNorm) {
  const RobotModel robot = test::talos();
  const std::vector<int> corners = {0, 1, 2, 3, 4, 5, 6, 7};
  ConstrainedDynamicsOracle oracle(robot, corners);
  test::NullSpaceDynamics reference(robot, corners);
  test::RandomStates random(robot, 22, 0.5);
  for (int i = 0; i < 20; ++i) {
    const Eigen::VectorXd q = random.configuration(), any = 100.0 * random.vector(24);
    reference.set_configuration(q);
    const auto motion = oracle.evaluate(q, Eigen::VectorXd::Zero(robot.nv()), random.torque());
    const Eigen::VectorXd internal = oracle.internal_part(any);
    EXPECT_GT(internal.norm(), 10.0);
    EXPECT_LT((reference.J.transpose() * internal).cwiseAbs().maxCoeff(), 1e-9);
    EXPECT_LT((oracle.internal_part(internal) - internal).norm(), 1e-9);
    EXPECT_LT(oracle.internal_part(motion.force).norm(), 1e-9 * motion.force.norm());
  }
  const RobotModel hyq = test::hyq();
  ConstrainedDynamicsOracle on_points(hyq, {0, 1, 2, 3});
  on_points.evaluate(hyq.nominal_configuration(), Eigen::VectorXd::Zero(18), Eigen::VectorXd::Zero(12));
  EXPECT_EQ(on_points.internal_part(Eigen::VectorXd::Ones(12)), Eigen::VectorXd::Zero(12));
}

// A proximal method adds what no acceleration can remove to the forces, step by step, over a small constant.
TEST(ConstrainedDynamicsOracle, ForcesOfAFootThatTurnsALittleAreThoseOfOneAtRest) {
  const RobotModel robot = test::talos();
  ConstrainedDynamicsOracle oracle(robot, {0, 1, 2, 3, 4, 5, 6, 7});
  const Eigen::VectorXd& q = robot.nominal_configuration();
  Eigen::VectorXd v = Eigen::VectorXd::Zero(robot.nv()), tau = Eigen::VectorXd::Zero(robot.nu());
  const Eigen::VectorXd at_rest = oracle.evaluate(q, v, tau).force;
  v(3) = v(4) = 1e-3;  // [rad/s]
  EXPECT_GT(oracle.evaluate(q, v, tau).residual, 1e-9) << "the corners agree, so the test checks nothing";
  EXPECT_LT((oracle.evaluate(q, v, tau).force - at_rest).norm(), 1e-3 * at_rest.norm());
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

TEST(ConstrainedDynamicsOracle, VelocityOfAContactIsTheRateOfItsPosition) {
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

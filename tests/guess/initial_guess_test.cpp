#include "prowl/guess/initial_guess.hpp"

#include <gtest/gtest.h>

#include <numeric>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/rigid_body_terms.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/zero_cost.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr int kIntervals = 40;  // of each phase, if not said otherwise

/// A motion of 2 s on all contacts, from rest in the nominal posture, heading away from the x axis.
MotionProblem standing(const RobotDescription& description) {
  MotionProblem problem{.robot = RobotModel(description)};
  problem.surfaces = {Surface{}};
  Phase phase{.name = "stand", .duration = {2.0, 2.0}};
  for (int c = 0; c < static_cast<int>(problem.robot.contacts().size()); ++c) phase.contacts.push_back({c, 0});
  problem.phases = {phase};
  const VectorXd turn = 1.2 * VectorXd::Unit(problem.robot.nv(), 5);
  auto start = BoundaryConstraint::unbounded(problem.robot, "start", PhaseFraction::start_of(0),
                                             integrate(problem.robot.nominal_configuration(), turn));
  start.configuration_lower.setZero();
  start.configuration_upper.setZero();
  start.velocity_lower.setZero();
  start.velocity_upper.setZero();
  problem.boundary_constraints = {start};
  problem.running_cost = problem.terminal_cost = test::zero_cost(problem.robot);
  return problem;
}

/// Asks the base to be displaced from the start by (world displacement, rotation vector) and at rest at a moment.
BoundaryConstraint base_goal(const MotionProblem& problem, PhaseFraction at, const Vector3d& shift,
                             const Vector3d& turn) {
  VectorXd displacement = VectorXd::Zero(problem.robot.nv());
  displacement.head<3>() = shift;
  displacement.segment<3>(3) = turn;
  auto goal =
      BoundaryConstraint::unbounded(problem.robot, "goal", at, integrate(problem.start_configuration(), displacement));
  goal.configuration_lower.head<6>().setZero();
  goal.configuration_upper.head<6>().setZero();
  goal.velocity_lower.head<6>().setZero();
  goal.velocity_upper.head<6>().setZero();
  return goal;
}

/// A goal for the base in every direction, in reach of every robot.
MotionProblem reaching(const RobotDescription& description) {
  MotionProblem problem = standing(description);
  const double height = problem.start_configuration()(2);
  problem.boundary_constraints.push_back(
      base_goal(problem, PhaseFraction::end_of(0), height * Vector3d(0.07, 0.05, -0.1), Vector3d(0.05, 0.1, 0.1)));
  return problem;
}

Trajectory guess_of(const MotionProblem& problem, int intervals = kIntervals) {
  return initial_guess(test::on_even_mesh(problem, intervals));
}

Vector3d contact_position(const RobotModel& robot, const VectorXd& q, int contact) {
  RigidBodyTerms terms(robot);
  terms.update_kinematics(q);
  return terms.contact_position(contact);
}

void expect_meets_constraints(const MotionProblem& problem, const Trajectory& guess, int intervals = kIntervals) {
  const auto expect_between = [](const VectorXd& x, const VectorXd& lower, const VectorXd& upper) {
    EXPECT_GE((x - lower).minCoeff(), -1e-12);
    EXPECT_GE((upper - x).minCoeff(), -1e-12);
  };
  const std::vector<int> nodes = find_boundary_nodes(problem, test::even_mesh(problem, intervals));
  for (std::size_t c = 0; c < nodes.size(); ++c) {
    const BoundaryConstraint& constraint = problem.boundary_constraints[c];
    const TrajectoryPoint& point = guess.nodes[nodes[c]];
    SCOPED_TRACE(constraint.name);
    expect_between(difference(constraint.q_ref, point.q), constraint.configuration_lower,
                   constraint.configuration_upper);
    expect_between(point.v, constraint.velocity_lower, constraint.velocity_upper);
    expect_between(point.tau, constraint.torque_lower, constraint.torque_upper);
  }
}

void expect_finite_and_within_limits(const MotionProblem& problem, const Trajectory& guess,
                                     int intervals = kIntervals) {
  const RobotModel& robot = problem.robot;
  ASSERT_EQ(static_cast<int>(guess.nodes.size()), test::even_mesh(problem, intervals).num_nodes());
  for (const TrajectoryPoint& point : guess.nodes) {
    ASSERT_TRUE(point.q.allFinite() && point.v.allFinite() && point.a.allFinite() && point.tau.allFinite() &&
                point.force.allFinite());
    EXPECT_NEAR(base_quaternion(point.q).norm(), 1.0, 1e-12);
    const auto joints = point.q.tail(robot.nu()).array();
    EXPECT_TRUE((joints >= robot.position_lower().array()).all() && (joints <= robot.position_upper().array()).all());
    EXPECT_TRUE((point.v.tail(robot.nu()).array().abs() <= robot.velocity_limit().array()).all());
    EXPECT_TRUE((point.tau.array().abs() <= robot.torque_limit().array()).all());
  }
}

/// M a + h - S' tau - J' f.
VectorXd equations_of_motion(const RobotModel& robot, const TrajectoryPoint& point) {
  RigidBodyTerms terms(robot);
  terms.update(point.q, point.v, point.a);
  std::vector<int> contacts(robot.contacts().size());
  std::iota(contacts.begin(), contacts.end(), 0);
  ContactKinematics kinematics(contacts);
  kinematics.set_configuration(terms);
  VectorXd left = terms.inverse_dynamics() - kinematics.jacobian().transpose() * point.force;
  left.tail(robot.nu()) -= point.tau;
  return left;
}

class InitialGuessOf : public testing::TestWithParam<RobotDescription> {};

TEST_P(InitialGuessOf, GoesToTheGoalWithItsFeetInPlace) {
  const MotionProblem problem = reaching(GetParam());
  const Trajectory guess = guess_of(problem);
  expect_finite_and_within_limits(problem, guess);
  expect_meets_constraints(problem, guess);

  for (const TrajectoryPoint& point : guess.nodes) {
    for (const PhaseContact& c : problem.phases[0].contacts) {
      const Vector3d drift = contact_position(problem.robot, point.q, c.contact) -
                             contact_position(problem.robot, problem.start_configuration(), c.contact);
      EXPECT_LT(drift.norm(), 1e-3) << problem.robot.contacts()[c.contact].name;
    }
    EXPECT_LT(equations_of_motion(problem.robot, point).norm(), 1e-9 * problem.robot.weight());
  }
}

TEST_P(InitialGuessOf, HasVelocitiesAndAccelerationsThatBelongToItsMotion) {
  const MotionProblem problem = reaching(GetParam());
  const Trajectory guess = guess_of(problem);

  double largest_step = 0.0, largest_defect = 0.0, largest_change = 0.0, largest_velocity_defect = 0.0;
  for (std::size_t k = 0; k + 1 < guess.nodes.size(); ++k) {
    const TrajectoryPoint &left = guess.nodes[k], &right = guess.nodes[k + 1];
    const double h = right.time - left.time;
    const VectorXd step = difference(left.q, right.q);
    const VectorXd defect = difference(right.q, interpolate(left, right, h).q);
    largest_step = std::max(largest_step, step.lpNorm<Eigen::Infinity>());
    largest_defect = std::max(largest_defect, defect.lpNorm<Eigen::Infinity>());
    const VectorXd velocity_defect = right.v - left.v - h / 2.0 * (left.a + right.a);
    largest_change = std::max(largest_change, (right.v - left.v).lpNorm<Eigen::Infinity>());
    largest_velocity_defect = std::max(largest_velocity_defect, velocity_defect.lpNorm<Eigen::Infinity>());
  }
  EXPECT_GT(largest_step, 1e-3) << "the robot does not move";
  EXPECT_LT(largest_defect, 0.05 * largest_step);
  EXPECT_LT(largest_velocity_defect, 0.5 * largest_change);  // the path's acceleration jumps at its ends
}

TEST_P(InitialGuessOf, IsFiniteAndWithinLimitsForAGoalOutOfReach) {
  for (const double rise : {1.5, -0.9}) {
    MotionProblem problem = standing(GetParam());
    const double height = problem.start_configuration()(2);
    problem.boundary_constraints.push_back(
        base_goal(problem, PhaseFraction::end_of(0), Vector3d(0.0, 0.0, rise * height), Vector3d(3.0, 0.0, 0.0)));
    const Trajectory guess = guess_of(problem);
    expect_finite_and_within_limits(problem, guess);
    expect_meets_constraints(problem, guess);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, InitialGuessOf,
                         testing::Values(test::hyq_description(), test::anymal_c_description(),
                                         test::solo12_description(), test::go2_description(),
                                         test::talos_description()),
                         [](const auto& info) { return info.param.name.substr(0, info.param.name.find(' ')); });

TEST(InitialGuess, GoesDownAndUpAgainForACrouchWithoutOvershoot) {
  MotionProblem problem = standing(test::hyq_description());
  problem.boundary_constraints.push_back(base_goal(problem, {0, 0.5}, Vector3d(0.0, 0.0, -0.17), Vector3d::Zero()));
  problem.boundary_constraints.push_back(
      base_goal(problem, PhaseFraction::end_of(0), Vector3d::Zero(), Vector3d::Zero()));
  const Trajectory guess = guess_of(problem);
  expect_meets_constraints(problem, guess);
  const double top = problem.start_configuration()(2);
  for (std::size_t k = 0; k < 40; ++k) {
    const double z = guess.nodes[k].q(2), next = guess.nodes[k + 1].q(2);
    EXPECT_EQ(next < z, k < 20);
    EXPECT_GE(z, top - 0.17 - 1e-12);
    EXPECT_LE(z, top + 1e-12);
  }
}

TEST(InitialGuess, LetsFreeCoordinatesPassAWaypoint) {
  MotionProblem problem = standing(test::hyq_description());
  auto halfway = BoundaryConstraint::unbounded(
      problem.robot, "height only", {0, 0.5},
      integrate(problem.start_configuration(), VectorXd::Unit(problem.robot.nv(), 2) * -0.1));
  halfway.configuration_lower(2) = halfway.configuration_upper(2) = 0.0;
  problem.boundary_constraints.push_back(halfway);
  problem.boundary_constraints.push_back(
      base_goal(problem, PhaseFraction::end_of(0), Vector3d(0.08, 0.0, -0.1), Vector3d::Zero()));
  const Trajectory guess = guess_of(problem);
  expect_meets_constraints(problem, guess);
  EXPECT_NEAR(guess.nodes[20].q(0), problem.start_configuration()(0) + 0.04, 1e-9) << "forward is halfway at half time";
}

TEST(InitialGuess, PassesAWaypointAtThePrescribedVelocity) {
  MotionProblem problem = standing(test::hyq_description());
  BoundaryConstraint passing = base_goal(problem, {0, 0.5}, Vector3d(0.02, 0.03, -0.03), Vector3d::Zero());
  const Vector3d velocity(0.06, -0.02, -0.03);  // in the base frame
  passing.velocity_lower.head<3>() = passing.velocity_upper.head<3>() = velocity;
  problem.boundary_constraints.push_back(passing);
  problem.boundary_constraints.push_back(
      base_goal(problem, PhaseFraction::end_of(0), Vector3d(0.04, 0.06, -0.06), Vector3d::Zero()));
  const Trajectory guess = guess_of(problem);
  expect_meets_constraints(problem, guess);
  const Vector3d moved = guess.nodes[21].q.head<3>() - guess.nodes[19].q.head<3>();
  EXPECT_LT((moved / 0.1 - base_rotation(guess.nodes[20].q) * velocity).norm(), 0.1 * velocity.norm());
}

TEST(InitialGuess, KeepsThePostureOfLegsInTheAir) {
  MotionProblem problem = standing(test::hyq_description());
  const int lf = problem.robot.contact_index("lf_foot");
  Phase lifted = problem.phases[0];
  std::erase_if(lifted.contacts, [&](const PhaseContact& c) { return c.contact == lf; });
  problem.phases.push_back(lifted);
  problem.boundary_constraints.push_back(
      base_goal(problem, PhaseFraction::end_of(1), Vector3d(-0.04, -0.04, 0.02), {0.0, -0.05, 0.0}));
  const Trajectory guess = guess_of(problem, 20);
  expect_finite_and_within_limits(problem, guess, 20);
  expect_meets_constraints(problem, guess, 20);

  const TrajectoryPoint &before = guess.nodes[20], &after = guess.nodes[21];  // both sides of the phase switch
  EXPECT_LT(difference(before.q, after.q).norm(), 1e-12);
  EXPECT_LT((before.v - after.v).norm(), 1e-10);
  EXPECT_GT(before.v.norm(), 1e-3);
  const auto leg = [&](std::size_t k) -> Vector3d { return guess.nodes[k].q.segment<3>(7); };  // lf: the first three
  EXPECT_GT((leg(20) - leg(0)).norm(), 1e-3);
  EXPECT_LT((leg(41) - leg(21)).norm(), 1e-12);
  EXPECT_GT(guess.nodes[19].force.segment<3>(3 * lf).norm(), 1.0);
  EXPECT_EQ(before.force.segment<3>(3 * lf).norm(), 0.0) << "unloaded before it opens";
  EXPECT_EQ(after.force.segment<3>(3 * lf).norm(), 0.0);
}

TEST(InitialGuess, BringsJointsToAPrescribedPosture) {
  MotionProblem problem = standing(test::hyq_description());
  problem.phases[0].contacts.clear();
  const VectorXd change = VectorXd::Unit(problem.robot.nv(), 7) * 0.3;
  auto posture = BoundaryConstraint::unbounded(problem.robot, "posture", PhaseFraction::end_of(0),
                                               integrate(problem.start_configuration(), change));
  posture.configuration_lower.tail(problem.robot.nu()).setZero();
  posture.configuration_upper.tail(problem.robot.nu()).setZero();
  problem.boundary_constraints.push_back(posture);
  const Trajectory guess = guess_of(problem);
  expect_meets_constraints(problem, guess);
  EXPECT_NEAR(guess.nodes[20].q(8), problem.start_configuration()(8) + 0.15, 1e-9);
}

TEST(InitialGuess, PutsAPrescribedJointBeforeTheFeet) {
  MotionProblem problem = standing(test::hyq_description());
  const VectorXd change = VectorXd::Unit(problem.robot.nv(), 7) * 0.3;
  auto posture = BoundaryConstraint::unbounded(problem.robot, "one joint", PhaseFraction::end_of(0),
                                               integrate(problem.start_configuration(), change));
  posture.configuration_lower(7) = posture.configuration_upper(7) = 0.0;
  problem.boundary_constraints.push_back(posture);
  expect_meets_constraints(problem, guess_of(problem));
}

/// HyQ lifts a foot, and puts it down 20 cm ahead.
MotionProblem stepping() {
  MotionProblem problem = standing(test::hyq_description());
  problem.swing_clearance = 0.05;
  const int lf = problem.robot.contact_index("lf_foot");
  Phase& shift = problem.phases[0];
  shift.duration = {0.8, 0.8};
  Phase swing = shift, settle = shift;
  std::erase_if(swing.contacts, [&](const PhaseContact& c) { return c.contact == lf; });
  const Vector3d from = contact_position(problem.robot, problem.start_configuration(), lf);
  for (PhaseContact& c : settle.contacts) {
    if (c.contact == lf) c.foothold = Vector3d(from.x() + 0.2, from.y(), 0.0);
  }
  problem.phases.push_back(swing);
  problem.phases.push_back(settle);
  return problem;
}

TEST(InitialGuess, FeetGoFromFootholdToFootholdAboveTheGround) {
  const MotionProblem problem = stepping();
  const int lf = problem.robot.contact_index("lf_foot");
  const Trajectory guess = guess_of(problem);
  expect_finite_and_within_limits(problem, guess);
  const Vector3d start = contact_position(problem.robot, problem.start_configuration(), lf);
  for (const TrajectoryPoint& point : guess.nodes) {
    const Vector3d foot = contact_position(problem.robot, point.q, lf);
    if (point.phase == 0) EXPECT_LT((foot - start).norm(), 1e-6);
    if (point.phase == 1) EXPECT_GT(foot.z(), start.z() - 1e-6);
    if (point.phase == 2) EXPECT_LT((foot - start - Vector3d(0.2, 0.0, 0.0)).norm(), 1e-6);
  }
  EXPECT_GT(contact_position(problem.robot, guess.nodes[41 + 20].q, lf).z(), start.z() + problem.swing_clearance);
}

TEST(InitialGuess, LeansAwayFromAFootThatLifts) {
  const MotionProblem problem = stepping();
  const Vector3d foot =
      contact_position(problem.robot, problem.start_configuration(), problem.robot.contact_index("lf_foot"));
  const Trajectory guess = guess_of(problem);
  const TrajectoryPoint& lifted = guess.nodes[41 + 20];
  EXPECT_LT(lifted.q.head<2>().dot(foot.head<2>().normalized()), -0.02);
  for (std::size_t c = 0; c < problem.robot.contacts().size(); ++c) {
    if (static_cast<int>(c) == problem.robot.contact_index("lf_foot")) continue;
    EXPECT_GT(lifted.force(3 * static_cast<Eigen::Index>(c) + 2), 0.0) << "no foot pulls";
  }
  for (const TrajectoryPoint& point : guess.nodes) {
    EXPECT_LT(equations_of_motion(problem.robot, point).norm(), 1e-9 * problem.robot.weight());
  }
}

}  // namespace
}  // namespace prowl

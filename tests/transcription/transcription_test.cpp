#include "prowl/transcription/transcription.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/nlp/derivative_check.hpp"
#include "prowl/transcription/initial_guess.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

Phase phase_on(std::string name, const std::vector<int>& contacts, double duration, int intervals) {
  Phase phase{.name = std::move(name), .duration = {duration, duration}, .intervals = intervals};
  for (const int contact : contacts) phase.contacts.push_back({contact, 0});
  return phase;
}

BoundaryCondition fixed_start(const RobotModel& robot) {
  auto start = BoundaryCondition::unbounded(robot, "start", {0, 0}, robot.nominal_configuration());
  start.configuration_lower.setZero();
  start.configuration_upper.setZero();
  start.velocity_lower.setZero();
  start.velocity_upper.setZero();
  return start;
}

/// Every kind of cost, constraint and phase at once, with weights that are all different.
MotionProblem everything(RobotModel robot, const std::vector<Phase>& phases) {
  const int nv = robot.nv(), nu = robot.nu();
  MotionProblem problem{.name = "everything", .robot = std::move(robot)};
  problem.surfaces = {Surface{.normal = Eigen::Vector3d(0.1, -0.2, 1.0).normalized()}};
  problem.phases = phases;
  problem.boundary_conditions = {fixed_start(problem.robot)};
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(nv);
  displacement.head<6>() << 0.05, 0.03, -0.05, 0.3, -0.2, 0.4;
  const Eigen::VectorXd goal_q = integrate(problem.robot.nominal_configuration(), displacement);
  const int last = static_cast<int>(phases.size()) - 1;
  auto goal = BoundaryCondition::unbounded(problem.robot, "goal", {last, phases.back().intervals}, goal_q);
  goal.configuration_lower.head<6>().setZero();
  goal.configuration_upper.head<6>().setZero();
  problem.boundary_conditions.push_back(goal);

  QuadraticCost& cost = problem.running_cost;
  cost.q_ref = goal_q;
  cost.configuration_weight = Eigen::VectorXd::LinSpaced(nv, 1.0, 3.0);
  cost.velocity_weight = Eigen::VectorXd::LinSpaced(nv, 0.1, 0.5);
  cost.acceleration_weight = Eigen::VectorXd::LinSpaced(nv, 0.01, 0.02);
  cost.tau_ref = Eigen::VectorXd::Constant(nu, 3.0);
  cost.torque_weight = Eigen::VectorXd::LinSpaced(nu, 0.001, 0.002);
  cost.force_weight = Eigen::Vector3d(3e-4, 2e-4, 1e-4);
  cost.contact_positions = {{2, {0.1, 0.2, 0.3}, {4.0, 5.0, 6.0}}};
  problem.terminal_cost = cost;
  problem.terminal_cost.contact_positions = {{0, {0.3, 0.2, 0.1}, {7.0, 5.0, 6.0}}, {3, {0.0, 0.2, 0.1}, {1.0, 2.0, 3.0}}};
  return problem;
}

void expect_derivatives(const MotionProblem& problem, double size_of_multipliers = 2.0) {
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess = initial_guess(problem, mesh);
  Transcription nlp(problem, mesh, guess);
  std::mt19937 rng(5);
  const Eigen::VectorXd z = nlp.pack(guess) + test::random_vector(rng, nlp.num_variables(), 0.1);
  const Eigen::VectorXd multipliers = test::random_vector(rng, nlp.num_constraints(), size_of_multipliers);
  const DerivativeReport report = check_derivatives(nlp, z, 1.7, multipliers);
  EXPECT_LT(report.worst(), 1e-6) << report.summary();
  EXPECT_TRUE(report.pattern_faults.empty()) << report.pattern_faults.front();
}

TEST(Transcription, DerivativesAndPatternsAreThoseOfDifferences) {
  const RobotModel hyq = test::hyq();
  expect_derivatives(everything(hyq, {phase_on("four", {0, 1, 2, 3}, 0.3, 2), phase_on("three", {0, 1, 3}, 0.2, 1)}));
  expect_derivatives(everything(hyq, {phase_on("hind", {1, 3}, 0.3, 1), phase_on("flight", {}, 0.2, 1)}));
}

TEST(Transcription, DerivativesHoldForASmallRobotToo) {
  expect_derivatives(everything(test::solo12(), {phase_on("four", {0, 1, 2, 3}, 0.2, 2)}));
}

Phase free_phase(std::string name, const std::vector<int>& contacts, int intervals) {
  Phase phase = phase_on(std::move(name), contacts, 0.3, intervals);
  phase.duration = {0.2, 0.5};
  return phase;
}

TEST(Transcription, DerivativesHoldForFreeDurations) {
  MotionProblem problem = everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("two", {0, 3}, 0.2, 1),
                                                   free_phase("flight", {}, 2)});
  problem.running_cost.time_weight = 2.3;
  expect_derivatives(problem);
}

TEST(Transcription, DerivativesHoldForContactsThatOpenAndLand) {
  MotionProblem problem =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                               free_phase("landed", {0, 1, 2, 3}, 2), free_phase("on it", {0, 3}, 1)});
  problem.swing_clearance = 0.05;
  problem.surfaces.push_back({.name = "wall", .point = {1.0, 0.0, 0.0}, .normal = {-1.0, 0.0, 0.0}});
  problem.phases[2].contacts[0].surface = 1;
  expect_derivatives(problem);
}

TEST(Transcription, DerivativesHoldForTorqueCurves) {
  RobotDescription description = test::hyq_description();
  for (const char* joint : {"lf_kfe_joint", "rh_kfe_joint"}) {
    description.limits[joint].torque_over_position = {{-3.0, 60.0}, {-2.0, 120.0}, {-1.0, 140.0}, {0.0, 120.0}, {1.5, 90.0}, {3.0, 50.0}};
    description.limits[joint].torque_over_velocity = {{-20.0, 150.0}, {0.0, 140.0}, {10.0, 100.0}, {20.0, 30.0}};
  }
  expect_derivatives(everything(RobotModel(description), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)}));
}

TEST(Transcription, DerivativesHoldForFlatFeetThatStandAndLand) {
  MotionProblem problem = everything(test::talos(), {phase_on("left", {0, 1, 2, 3}, 0.3, 1),
                                                     free_phase("both", {0, 1, 2, 3, 4, 5, 6, 7}, 1)});
  problem.running_cost.force_weight *= 0.1;  // heavier than HyQ: a cost of the same size, against rounding
  expect_derivatives(problem, 0.5);  // single corners carry little: forces near the tips of their cones, where they bend
}

TEST(Transcription, PackAndUnpackAreInverse) {
  const MotionProblem problem = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 3)});
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess = initial_guess(problem, mesh);
  Transcription nlp(problem, mesh, guess);
  std::mt19937 rng(5);
  const Eigen::VectorXd z = nlp.pack(guess) + test::random_vector(rng, nlp.num_variables(), 0.3);
  EXPECT_LT(test::relative_error(nlp.pack(nlp.unpack(z)), z), 1e-12);
}

TEST(Transcription, StandingStillInBalanceSatisfiesEverything) {
  const RobotModel robot = test::hyq();
  MotionProblem problem = everything(robot, {phase_on("a", {0, 1, 2, 3}, 0.4, 2), phase_on("b", {0, 1, 2, 3}, 0.4, 2)});
  problem.surfaces = {Surface{}};
  problem.boundary_conditions.resize(1);
  const Mesh mesh = make_mesh(problem);
  const Trajectory guess = initial_guess(problem, mesh);  // static: there is nowhere to go
  Transcription nlp(problem, mesh, guess);
  const Eigen::VectorXd z = nlp.pack(guess);
  Eigen::VectorXd g(nlp.num_constraints());
  nlp.constraints(z, g);
  EXPECT_LT((nlp.constraint_lower() - g).maxCoeff(), 1e-9);
  EXPECT_LT((g - nlp.constraint_upper()).maxCoeff(), 1e-9);
  EXPECT_LE((nlp.variable_lower() - z).maxCoeff(), 1e-12);
  EXPECT_LE((z - nlp.variable_upper()).maxCoeff(), 1e-12);

  // And a foot that pulls is noticed: forces are recovered from the torques, here with the sign of one knee changed.
  Eigen::VectorXd pulled = z;
  pulled(nlp.num_variables() - 1) *= -1.0;
  nlp.constraints(pulled, g);
  EXPECT_GT(g.cwiseAbs().maxCoeff(), 1e-2);
}

TEST(Transcription, NamesEveryConstraintAndVariable) {
  const MotionProblem problem = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2),
                                                         phase_on("three", {0, 1, 3}, 0.2, 1)});
  const Mesh mesh = make_mesh(problem);
  Transcription nlp(problem, mesh, initial_guess(problem, mesh));
  EXPECT_EQ(nlp.describe_constraint(0), "phase 1 'four', node 0, base force x, equations of motion, t = 0.000 s");
  EXPECT_EQ(nlp.describe_constraint(18 + 1), "phase 1 'four', node 0, lh_foot, friction cone, t = 0.000 s");
  EXPECT_EQ(nlp.describe_constraint(nlp.num_constraints() - 1),
            "phase 2 'three', node 0, rh_kfe_joint, velocity over the interval, t = 0.300 s");
  EXPECT_EQ(nlp.describe_variable(nlp.num_variables() - 1),
            "phase 2 'three', node 1, torque rh_kfe_joint, t = 0.500 s");
}

}  // namespace
}  // namespace prowl

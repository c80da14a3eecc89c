#include "prowl/transcription/transcription.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/model/configuration.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

using test::everything;
using test::free_phase;
using test::MeshedProblem;
using test::phase_on;

void expect_derivatives(const MeshedProblem& of, double size_of_multipliers = 2.0) {
  const DiscreteProblem discrete = of.discrete();
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  std::mt19937 rng(5);
  const Eigen::VectorXd z = nlp.pack(guess) + test::random_vector(rng, nlp.num_variables(), 0.1);
  const Eigen::VectorXd multipliers = test::random_vector(rng, nlp.num_constraints(), size_of_multipliers);
  const test::DerivativeReport report = test::check_derivatives(nlp, z, 1.7, multipliers);
  EXPECT_LT(report.worst(), 1e-6) << report.summary();
  EXPECT_TRUE(report.pattern_faults.empty()) << report.pattern_faults.front();
}

/// A motion with every joint at its lower limits is the lower bound of the variables, one at the upper limits the upper
/// one.
TEST(Transcription, BoundsOfJointsAreTheRobotsLimitsOnBothSides) {
  const auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 4)});
  const RobotModel& robot = problem.robot;
  const DiscreteProblem discrete(problem, mesh);
  Trajectory lowest = initial_guess(discrete), highest = lowest;
  for (std::size_t k = 0; k < lowest.nodes.size(); ++k) {
    TrajectoryPoint &low = lowest.nodes[k], &high = highest.nodes[k];
    low.q.tail(robot.nu()) = robot.position_lower();
    high.q.tail(robot.nu()) = robot.position_upper();
    low.v.tail(robot.nu()) = -robot.velocity_limit();
    high.v.tail(robot.nu()) = robot.velocity_limit();
    high.tau = robot.torque_limit() - robot.losses().torques(robot.velocity_limit());
    low.tau = -high.tau;
  }
  const Transcription nlp(discrete, initial_guess(discrete));
  const Eigen::VectorXd low = nlp.pack(lowest), high = nlp.pack(highest);
  int bounded = 0;
  for (int i = 0; i < nlp.num_variables(); ++i) {
    if (low(i) == high(i)) continue;                                   // not of a joint
    if (nlp.variable_lower()(i) == nlp.variable_upper()(i)) continue;  // the start
    EXPECT_EQ(nlp.variable_lower()(i), low(i)) << nlp.describe_variable(i);
    EXPECT_EQ(nlp.variable_upper()(i), high(i)) << nlp.describe_variable(i);
    ++bounded;
  }
  EXPECT_EQ(bounded, (5 * 3 - 2) * robot.nu()) << "position, velocity and torque; the start has torques only";
}

TEST(Transcription, DerivativesAndPatternsAreThoseOfDifferences) {
  const RobotModel hyq = test::hyq();
  expect_derivatives(everything(hyq, {phase_on("four", {0, 1, 2, 3}, 0.3, 2), phase_on("three", {0, 1, 3}, 0.2, 1)}));
  expect_derivatives(everything(hyq, {phase_on("hind", {1, 3}, 0.3, 1), phase_on("flight", {}, 0.2, 1)}));
}

TEST(Transcription, DerivativesHoldForASmallRobotToo) {
  expect_derivatives(everything(test::solo12(), {phase_on("four", {0, 1, 2, 3}, 0.2, 2)}));
}

TEST(Transcription, DerivativesHoldForFreeDurations) {
  MeshedProblem of = everything(
      test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("two", {0, 3}, 0.2, 1), free_phase("flight", {}, 2)});
  of.problem.running_cost.time_weight = 2.3;
  expect_derivatives(of);
}

TEST(Transcription, DerivativesHoldForTermsOfTheUser) {
  MeshedProblem of = everything(
      test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("two", {0, 3}, 0.2, 1), free_phase("flight", {}, 2)});
  of.problem.terms = test::every_term(of.problem.robot, "lf_foot", "rh_upperleg", 3);
  expect_derivatives(of);
}

TEST(Transcription, DerivativesHoldForStepsOfDifferentLength) {
  MeshedProblem of =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 3), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                               free_phase("landed", {0, 1, 2, 3}, 2)});
  of.problem.swing_clearance = 0.05;
  of.problem.running_cost.time_weight = 2.3;
  of.mesh.phases = {PhaseMesh({0.2, 0.7, 0.1}), PhaseMesh({0.8, 0.2}), PhaseMesh({0.4, 0.6})};
  expect_derivatives(of);
}

TEST(Transcription, DerivativesHoldForContactsThatOpenAndLand) {
  MeshedProblem of =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 2), phase_on("lifted", {1, 2, 3}, 0.2, 2),
                               free_phase("landed", {0, 1, 2, 3}, 2), free_phase("on it", {0, 3}, 1)});
  of.problem.swing_clearance = 0.05;
  of.problem.surfaces.push_back({.name = "wall", .point = {1.0, 0.0, 0.0}, .normal = {-1.0, 0.0, 0.0}});
  of.problem.phases[2].contacts[0].surface = of.problem.phases[3].contacts[0].surface = 1;
  expect_derivatives(of);
}

TEST(Transcription, DerivativesHoldForAPatchThatAContactLandsIn) {
  MeshedProblem of =
      everything(test::hyq(), {phase_on("lifted", {1, 2, 3}, 0.2, 2), free_phase("landed", {0, 1, 2, 3}, 2)});
  of.problem.swing_clearance = 0.05;
  of.problem.surfaces.push_back({.name = "step",
                                 .point = {0.4, 0.3, 0.1},
                                 .normal = {0.1, 0.0, 1.0},
                                 .patch = {{-0.1, -0.1}, {0.1, -0.1}, {0.1, 0.1}, {-0.1, 0.1}}});
  of.problem.surfaces[1].normal.normalize();
  of.problem.phases[1].contacts[0].surface = 1;
  expect_derivatives(of);
}

/// Rows that say a contact's landing place is inside a patch are zero on an edge, positive inside.
TEST(Transcription, LandsInsideThePatch) {
  auto [problem, mesh] =
      everything(test::hyq(), {phase_on("lifted", {1, 2, 3}, 0.2, 2), phase_on("landed", {0, 1, 2, 3}, 0.2, 2)});
  problem.surfaces.push_back(
      {.name = "step", .point = {0.4, 0.3, 0.0}, .patch = {{-0.1, -0.2}, {0.1, -0.2}, {0.1, 0.2}, {-0.1, 0.2}}});
  problem.phases[1].contacts[0].surface = 1;
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  Eigen::VectorXd z = nlp.pack(guess), g(nlp.num_constraints());
  const auto inside = [&](double x, double y) {  // place on the surface, the last two variables
    z.tail<2>() << x, y;
    nlp.constraints(z, g);
    std::vector<double> rows;
    for (int row = 0; row < g.size(); ++row) {
      if (nlp.describe_constraint(row).find("landing place inside step") == std::string::npos) continue;
      EXPECT_EQ(nlp.constraint_lower()(row), 0.0);
      rows.push_back(g(row) * problem.robot.size());  // [m]
    }
    std::ranges::sort(rows);
    return rows;
  };
  EXPECT_THAT(inside(0.0, 0.0), testing::Pointwise(testing::DoubleNear(1e-9), {0.1, 0.1, 0.2, 0.2}));
  EXPECT_NEAR(inside(0.1, 0.05).front(), 0.0, 1e-9);
  EXPECT_NEAR(inside(-0.13, 0.05).front(), -0.03, 1e-9);
  EXPECT_NEAR(inside(0.05, 0.21).front(), -0.01, 1e-9);
}

/// A contact that the start has in the air, on the ground here, is not asked to be higher at once.
TEST(Transcription, ClearanceGrowsFromTheStart) {
  auto [problem, mesh] =
      everything(test::hyq(), {phase_on("lifted", {1, 2, 3}, 0.2, 10), phase_on("landed", {0, 1, 2, 3}, 0.2, 2)});
  problem.swing_clearance = 0.05;
  const DiscreteProblem discrete(problem, mesh);
  Transcription nlp(discrete, initial_guess(discrete));
  std::vector<double> heights;  // [m]
  for (int row = 0; row < nlp.num_constraints(); ++row) {
    if (nlp.describe_constraint(row).find("clearance") == std::string::npos) continue;
    heights.push_back(nlp.constraint_lower()(row) * problem.robot.size());
  }
  ASSERT_EQ(heights.size(), 9u);
  EXPECT_NEAR(heights[0], 0.05 * 16 * 0.01 * 0.81, 1e-12);
  EXPECT_NEAR(heights[4], 0.05, 1e-12);
  EXPECT_NEAR(heights[8], heights[0], 1e-12);
}

std::vector<double> clearances(const DiscreteProblem& discrete) {
  const Transcription nlp(discrete, initial_guess(discrete));
  std::vector<double> heights;  // [m]
  for (int row = 0; row < nlp.num_constraints(); ++row) {
    if (nlp.describe_constraint(row).find("clearance") == std::string::npos) continue;
    heights.push_back(nlp.constraint_lower()(row) * discrete.problem.robot.size());
  }
  return heights;
}

/// Through two phases, the first a quarter of the swing: whatever the nodes, a foot has to be at a height at a time.
TEST(Transcription, ClearanceIsAMatterOfTimeNotOfNodes) {
  auto [problem, mesh] =
      everything(test::hyq(), {phase_on("lifted", {1, 2, 3}, 0.1, 2), phase_on("still", {1, 2, 3}, 0.3, 2),
                               phase_on("landed", {0, 1, 2, 3}, 0.2, 1)});
  problem.swing_clearance = 0.05;
  mesh.phases[0] = PhaseMesh({0.8, 0.2});
  const auto at = [](double s) { return 0.05 * 16.0 * s * s * (1.0 - s) * (1.0 - s); };
  EXPECT_THAT(clearances({problem, mesh}),
              testing::Pointwise(testing::DoubleNear(1e-12), {at(0.2), at(0.25), at(0.625)}));
}

TEST(Transcription, DerivativesHoldForTorqueCurves) {
  RobotDescription description = test::hyq_description();
  for (const char* joint : {"lf_kfe_joint", "rh_kfe_joint"}) {
    description.limits[joint].torque_over_position = {{-3.0, 60.0}, {-2.0, 120.0}, {-1.0, 140.0},
                                                      {0.0, 120.0}, {1.5, 90.0},   {3.0, 50.0}};
    description.limits[joint].torque_over_velocity = {{-20.0, 150.0}, {0.0, 140.0}, {10.0, 100.0}, {20.0, 30.0}};
  }
  expect_derivatives(everything(RobotModel(description), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)}));
}

TEST(Transcription, DerivativesHoldForThePyramid) {
  MeshedProblem of =
      everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2), phase_on("three", {0, 1, 3}, 0.2, 1)});
  of.problem.friction_model = FrictionModel::pyramid;
  expect_derivatives(of);
}

TEST(Transcription, DerivativesHoldForFlatFeetThatStandAndLand) {
  MeshedProblem of = everything(
      test::talos(), {phase_on("left", {0, 1, 2, 3}, 0.3, 1), free_phase("both", {0, 1, 2, 3, 4, 5, 6, 7}, 1)});
  of.problem.running_cost.force_weight *= 0.1;  // heavier than HyQ: a cost of the same size, against rounding
  expect_derivatives(of,
                     0.5);  // single corners carry little: forces near the tips of their cones, where they bend
}

TEST(Transcription, PackAndUnpackAreInverse) {
  const auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 3)});
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  std::mt19937 rng(5);
  const Eigen::VectorXd z = nlp.pack(guess) + test::random_vector(rng, nlp.num_variables(), 0.3);
  EXPECT_LT(test::relative_error(nlp.pack(nlp.unpack(z)), z), 1e-12);
}

TEST(Transcription, QuaternionsDoNotJump) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("flight", {}, 2.0, 20)}, Surface{});
  problem.boundary_constraints.resize(1);
  Eigen::VectorXd turn = Eigen::VectorXd::Zero(problem.robot.nv());
  turn(5) = -2.4;  // beyond the half turn at which a quaternion made from a matrix changes its sign
  auto turned = BoundaryConstraint::unbounded(problem.robot, "turned", PhaseFraction::end_of(0),
                                              integrate(problem.robot.nominal_configuration(), turn));
  turned.configuration_lower.head<6>().setZero();
  turned.configuration_upper.head<6>().setZero();
  problem.boundary_constraints.push_back(turned);
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  const Trajectory motion = nlp.unpack(nlp.pack(guess));
  for (std::size_t k = 1; k < motion.nodes.size(); ++k) {
    EXPECT_GT(motion.nodes[k].q.segment<4>(3).dot(motion.nodes[k - 1].q.segment<4>(3)), 0.9);
  }
}

TEST(Transcription, ALimitCountsAgainstTheRoundingOfAGoal) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)});
  problem.boundary_constraints.resize(1);
  Eigen::VectorXd q = problem.robot.nominal_configuration();
  q(7) = problem.robot.position_upper()(0) + 5e-10;
  auto goal = BoundaryConstraint::unbounded(problem.robot, "goal", PhaseFraction::end_of(0), q);
  goal.configuration_lower(6) = goal.configuration_upper(6) = 0.0;
  problem.boundary_constraints.push_back(goal);
  const DiscreteProblem discrete(problem, mesh);
  const Transcription nlp(discrete, initial_guess(discrete));
  const int first = 2 * (3 * problem.robot.nv() + problem.robot.nu()) + 6;
  EXPECT_EQ(nlp.variable_lower()(first), problem.robot.position_upper()(0));
  EXPECT_EQ(nlp.variable_upper()(first), problem.robot.position_upper()(0));

  problem.boundary_constraints[1].q_ref(7) += 1e-3;
  EXPECT_THROW(DiscreteProblem(problem, mesh), InputError);
}

/// Each of them is possible, and both are not: within rounding they may miss each other.
TEST(Transcription, GoalsThatContradictEachOtherAreRefused) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2)});
  problem.boundary_constraints.push_back(problem.boundary_constraints[1]);
  problem.boundary_constraints[2].configuration_lower.segment<3>(3).setConstant(
      -std::numeric_limits<double>::infinity());
  problem.boundary_constraints[2].configuration_upper.segment<3>(3).setConstant(
      std::numeric_limits<double>::infinity());
  for (const double by : {0.0, 1e-3}) {
    problem.boundary_constraints[2].q_ref(0) = problem.boundary_constraints[1].q_ref(0) + by;
    const DiscreteProblem discrete(problem, mesh);
    const Trajectory guess = initial_guess(discrete);
    if (by > 0.0) {
      EXPECT_THROW(Transcription(discrete, guess), InputError);
    } else {
      EXPECT_NO_THROW(Transcription(discrete, guess));
    }
  }
}

/// Bounds of all variables at a node that say more than the robot's limits.
TEST(Transcription, LimitsAndGoalsAreBounds) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 3)});
  auto& goal = problem.boundary_constraints[1];
  goal.velocity_lower(2) = -0.1;
  goal.velocity_upper(2) = 0.2;
  goal.torque_lower(4) = 3.0;
  const DiscreteProblem discrete(problem, mesh);
  const Transcription nlp(discrete, initial_guess(discrete));
  const RobotModel& robot = problem.robot;
  const int nv = robot.nv(), nu = robot.nu(), size = 3 * nv + nu;
  const Eigen::VectorXd links = robot.torque_limit() - robot.losses().torques(robot.velocity_limit());
  for (int k = 1; k < 4; ++k) {
    EXPECT_EQ(nlp.variable_lower().segment(k * size + 6, nu), robot.position_lower());
    EXPECT_EQ(nlp.variable_upper().segment(k * size + 6, nu), robot.position_upper());
    EXPECT_EQ(nlp.variable_upper().segment(k * size + nv + 6, nu), robot.velocity_limit());
    EXPECT_EQ(nlp.variable_upper().segment(k * size + 3 * nv, nu), links);
    EXPECT_EQ(nlp.variable_lower()(k * size + 3 * nv + 4), k == 3 ? 3.0 : -links(4));
  }
  const int last = 3 * size;
  EXPECT_EQ(nlp.variable_lower()(last + nv + 2), -0.1);
  EXPECT_EQ(nlp.variable_upper()(last + nv + 2), 0.2);
  EXPECT_EQ(nlp.variable_lower().segment<3>(last), nlp.variable_upper().segment<3>(last));
  EXPECT_EQ(Eigen::Vector3d(nlp.variable_lower().segment<3>(last)), goal.q_ref.head<3>());
  EXPECT_TRUE(nlp.variable_upper().segment<3>(last + 3).isZero(0.0)) << "the chart is the goal's rotation";
}

/// The cone asks for the least load, and for nothing more than its tip without one.
TEST(Transcription, ConesAskForTheLeastLoad) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 3)});
  const Phase& phase = problem.phases[0];
  const double friction = problem.surfaces[0].friction, weight = problem.robot.weight();
  EXPECT_DOUBLE_EQ(cone_smoothing(problem, phase, phase.contacts[0]), weight * std::min(0.01, 0.05 * friction));
  problem.least_load = 0.4;
  const double level = problem.surfaces[0].normal.z();
  EXPECT_DOUBLE_EQ(cone_smoothing(problem, phase, phase.contacts[0]), 0.1 * weight * level * friction);
  problem.phases[0].contacts[0].unloaded = true;
  EXPECT_DOUBLE_EQ(cone_smoothing(problem, phase, phase.contacts[0]), weight * std::min(0.01, 0.05 * friction));
}

/// The running cost is integrated by the trapezoid: a motion that stands still costs its rate times the time.
TEST(Transcription, CostIsTheIntegralAndTheTerminalCost) {
  auto [problem, mesh] =
      everything(test::hyq(), {phase_on("a", {0, 1, 2, 3}, 0.3, 3), phase_on("b", {0, 1, 3}, 0.4, 2)});
  problem.boundary_constraints.resize(1);
  problem.running_cost.force_weight.setZero();
  problem.running_cost.contact_positions.clear();
  problem.terminal_cost.contact_positions.clear();
  problem.running_cost.time_weight = 0.7;
  const DiscreteProblem discrete(problem, mesh);
  Trajectory guess = initial_guess(discrete);
  for (TrajectoryPoint& point : guess.nodes) {
    point.q = problem.start_configuration();
    point.v.setConstant(0.2);
    point.a.setConstant(-0.3);
    point.tau.setConstant(5.0);
  }
  const auto state_cost = [&](const QuadraticCost& cost) {
    const Eigen::VectorXd d = difference(cost.q_ref, problem.start_configuration());
    return 0.5 * (d.cwiseAbs2().dot(cost.configuration_weight) + 0.04 * cost.velocity_weight.sum());
  };
  const double running = 0.7 + state_cost(problem.running_cost) +
                         0.5 * 0.09 * problem.running_cost.acceleration_weight.sum() +
                         0.5 * 4.0 * problem.running_cost.torque_weight.sum();
  Transcription nlp(discrete, guess);
  const double expected = 0.7 * running + state_cost(problem.terminal_cost);
  EXPECT_NEAR(nlp.cost(nlp.pack(guess)), expected, 1e-12 * expected);
}

/// Each interval with its own step.
TEST(Transcription, CostIsTheTrapezoidOfStepsOfDifferentLength) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("a", {0, 1, 2, 3}, 0.4, 3)});
  problem.boundary_constraints.resize(1);
  mesh.phases[0] = PhaseMesh({0.5, 0.2, 0.3});
  for (QuadraticCost* cost : {&problem.running_cost, &problem.terminal_cost}) {
    cost->configuration_weight.setZero();
    cost->velocity_weight.setZero();
    cost->acceleration_weight.setZero();
    cost->force_weight.setZero();
    cost->contact_positions.clear();
  }
  problem.running_cost.tau_ref.setZero();
  problem.running_cost.torque_weight.setConstant(2.0);
  const DiscreteProblem discrete(problem, mesh);
  Trajectory guess = initial_guess(discrete);
  for (int k = 0; k < 4; ++k) {
    guess.nodes[k].tau.setZero();
    guess.nodes[k].tau(0) = k + 1.0;  // costs its square
  }
  Transcription nlp(discrete, guess);
  const double expected = 0.5 * (0.2 * (1.0 + 4.0) + 0.08 * (4.0 + 9.0) + 0.12 * (9.0 + 16.0));
  EXPECT_NEAR(nlp.cost(nlp.pack(guess)), expected, 1e-12);
}

TEST(Transcription, UnpacksTheTimesOfItsMesh) {
  auto [problem, mesh] = everything(test::hyq(), {free_phase("a", {0, 1, 2, 3}, 3), phase_on("b", {0, 1, 3}, 0.4, 2)});
  mesh.phases[0] = PhaseMesh({0.5, 0.2, 0.3});
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  Eigen::VectorXd z = nlp.pack(guess);
  const int duration = static_cast<int>(z.size()) - 1;
  ASSERT_EQ(nlp.describe_variable(duration), "phase 1 'a', duration");
  z(duration) = 0.2;
  std::vector<double> times;
  for (const TrajectoryPoint& node : nlp.unpack(z).nodes) times.push_back(node.time);
  EXPECT_THAT(times, testing::Pointwise(testing::DoubleNear(1e-12), {0.0, 0.1, 0.14, 0.2, 0.2, 0.4, 0.6}));
}

/// What satisfies the defects is what interpolate() means: the certificate and the transcription read one trapezoid.
TEST(Transcription, DefectsVanishWhereTheInterpolationMeetsTheNextNode) {
  const auto [problem, mesh] = everything(test::hyq(), {phase_on("flight", {}, 0.3, 1)});
  const DiscreteProblem discrete(problem, mesh);
  Trajectory motion = initial_guess(discrete);
  std::mt19937 rng(13);
  for (TrajectoryPoint& point : motion.nodes) {
    point.v = test::random_vector(rng, problem.robot.nv(), 1.0);
    point.a = test::random_vector(rng, problem.robot.nv(), 3.0);
  }
  motion.nodes[1].v = motion.nodes[0].v + 0.15 * (motion.nodes[0].a + motion.nodes[1].a);
  // Twice: the place at the end depends on the rotation there.
  for (int i = 0; i < 2; ++i) motion.nodes[1].q = interpolate(motion.nodes[0], motion.nodes[1], 0.3).q;
  Transcription nlp(discrete, motion);
  Eigen::VectorXd g(nlp.num_constraints());
  nlp.constraints(nlp.pack(motion), g);
  EXPECT_LT(g.tail(2 * problem.robot.nv()).cwiseAbs().maxCoeff(), 1e-13);
  motion.nodes[1].time *= 1.1;  // no part of the variables: the step is the mesh's
  motion.nodes[1].q(9) += 1e-3;
  nlp.constraints(nlp.pack(motion), g);
  EXPECT_GT(g.tail(2 * problem.robot.nv()).cwiseAbs().maxCoeff(), 1e-4);
}

TEST(Transcription, StandingStillInBalanceSatisfiesEverything) {
  const RobotModel robot = test::hyq();
  auto [problem, mesh] =
      everything(robot, {phase_on("a", {0, 1, 2, 3}, 0.4, 2), phase_on("b", {0, 1, 2, 3}, 0.4, 2)}, Surface{});
  problem.boundary_constraints.resize(1);
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);  // static: there is nowhere to go
  Transcription nlp(discrete, guess);
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
  EXPECT_GT((nlp.constraint_lower() - g).maxCoeff(), 1e-2);
}

TEST(Transcription, NamesEveryConstraintAndVariable) {
  const auto [problem, mesh] =
      everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 2), phase_on("three", {0, 1, 3}, 0.2, 1)});
  const DiscreteProblem discrete(problem, mesh);
  Transcription nlp(discrete, initial_guess(discrete));
  EXPECT_EQ(nlp.describe_constraint(0), "phase 1 'four', node 0, base force x, equations of motion, t = 0.000 s");
  EXPECT_EQ(nlp.describe_constraint(18 + 1), "phase 1 'four', node 0, lh_foot, friction cone, t = 0.000 s");
  EXPECT_EQ(nlp.describe_constraint(nlp.num_constraints() - 1),
            "phase 2 'three', node 0, rh_kfe_joint, velocity over the interval, t = 0.300 s");
  EXPECT_EQ(nlp.describe_variable(nlp.num_variables() - 1),
            "phase 2 'three', node 1, torque rh_kfe_joint, t = 0.500 s");
}

}  // namespace
}  // namespace prowl

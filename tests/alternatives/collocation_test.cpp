#include "alternatives/collocation/collocation.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "alternatives/formulation.hpp"
#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/error.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "tests/support/derivative_check.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"

namespace prowl {
namespace {

using test::everything;
using test::free_phase;
using test::phase_on;

DiscreteProblem two_phases() {
  return everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.3, 1), phase_on("three", {0, 1, 3}, 0.2, 1)})
      .discrete();
}

// Steps of 0.1 s: an explicit rule bends so much over longer ones that differences are not good to 1e-6.
DiscreteProblem one_phase() { return everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.1, 1)}).discrete(); }

/// Contacts that open and land, durations and places that are variables.
DiscreteProblem a_step() {
  auto [problem, mesh] =
      everything(test::hyq(), {free_phase("four", {0, 1, 2, 3}, 1), phase_on("lifted", {1, 2, 3}, 0.1, 1),
                               free_phase("landed", {0, 1, 2, 3}, 1)});
  problem.phases.front().duration = problem.phases.back().duration = {0.05, 0.15};
  problem.swing_clearance = 0.05;
  problem.running_cost.time_weight = 2.3;
  return {std::move(problem), std::move(mesh)};
}

void expect_derivatives(const DiscreteProblem& discrete, const Formulation& formulation) {
  const Trajectory guess = initial_guess(discrete);
  const auto nlp = make_collocation(formulation, discrete, guess);
  std::mt19937 rng(5);
  const Eigen::VectorXd z = nlp->pack(guess) + test::random_vector(rng, nlp->num_variables(), 0.02);
  const Eigen::VectorXd multipliers = test::random_vector(rng, nlp->num_constraints(), 2.0);
  // The forward form solves for accelerations with a matrix of condition 1e5: gradients have lost as many digits to
  // rounding, and their differences more. With half the step they are twice as far off (seen), as rounding is.
  const double tolerance = formulation.dynamics == "forward" ? 1e-5 : 1e-6;
  const test::DerivativeReport report = test::check_derivatives(*nlp, z, 1.7, multipliers, {.step = 2e-4});
  EXPECT_LT(report.worst(), tolerance) << report.summary();
  EXPECT_TRUE(report.pattern_faults.empty()) << report.pattern_faults.front();
}

TEST(Collocation, DerivativesOfEachDynamicsAreThoseOfDifferences) {
  for (const std::string dynamics : {"inverse", "forward", "kkt"}) {
    SCOPED_TRACE(dynamics);
    expect_derivatives(two_phases(), {.dynamics = dynamics});
  }
}

TEST(Collocation, DerivativesOfEachRuleAreThoseOfDifferences) {
  for (const std::string rule : {"hermite-simpson", "hermite-simpson-separated"}) {
    for (const std::string dynamics : {"inverse", "forward", "kkt"}) {
      SCOPED_TRACE(rule + ", " + dynamics);
      expect_derivatives(one_phase(), {.dynamics = dynamics, .transcription = rule});
    }
  }
  expect_derivatives(one_phase(), {.dynamics = "forward", .transcription = "rk4"});
}

TEST(Collocation, DerivativesOfEachWayToKeepContactsAreThoseOfDifferences) {
  for (const std::string& contact : contact_names()) {
    SCOPED_TRACE(contact);
    expect_derivatives(one_phase(), {.contact = contact});
  }
}

TEST(Collocation, DerivativesHoldForEulerAngles) {
  expect_derivatives(one_phase(), {.dynamics = "forward", .contact = "distance", .orientation = "euler"});
  expect_derivatives(one_phase(), {.transcription = "hermite-simpson", .orientation = "euler"});
}

TEST(Collocation, DerivativesHoldForFreeDurationsAndFootholds) {
  expect_derivatives(a_step(), {.dynamics = "kkt"});
  expect_derivatives(a_step(), {.dynamics = "forward", .transcription = "hermite-simpson"});
  expect_derivatives(a_step(), {.dynamics = "forward", .transcription = "rk4"});
  expect_derivatives(a_step(), {.contact = "distance-velocity-acceleration"});
  expect_derivatives(a_step(), {.dynamics = "forward", .contact = "distance-5mm"});
}

/// Without the bending of the rows it is the same at all multipliers.
TEST(Collocation, GaussNewtonLeavesOutTheRows) {
  const DiscreteProblem discrete = a_step();
  const Trajectory guess = initial_guess(discrete);
  for (const std::string dynamics : {"inverse", "forward", "kkt"}) {
    SCOPED_TRACE(dynamics);
    const auto nlp = make_collocation({.dynamics = dynamics, .orientation = "euler"}, discrete, guess);
    nlp->use_hessian(HessianKind::gauss_newton);
    std::mt19937 rng(7);
    const Eigen::VectorXd z = nlp->pack(guess) + test::random_vector(rng, nlp->num_variables(), 0.02);
    const Eigen::VectorXd multipliers = test::random_vector(rng, nlp->num_constraints(), 2.0);
    const SparsityPattern& pattern = nlp->hessian_pattern();
    Eigen::VectorXd values(pattern.size()), without(pattern.size());
    nlp->hessian(z, 1.7, multipliers, values);
    nlp->hessian(z, 1.7, Eigen::VectorXd::Zero(nlp->num_constraints()), without);
    EXPECT_EQ(values, without);
    nlp->use_hessian(HessianKind::exact);
    nlp->hessian(z, 1.7, multipliers, values);
    EXPECT_GT((values - without).norm(), 1e-3 * without.norm()) << "nothing to leave out";
  }
}

/// What a rule has in the middle of an interval comes back too, where the motion has it: cubics, and the torque there.
TEST(Collocation, PacksWhatItUnpacked) {
  const DiscreteProblem discrete = a_step();
  const Trajectory guess = initial_guess(discrete);
  const auto nlp = make_collocation({.dynamics = "forward", .transcription = "hermite-simpson"}, discrete, guess);
  std::mt19937 rng(8);
  const Eigen::VectorXd z = nlp->pack(guess) + test::random_vector(rng, nlp->num_variables(), 0.05);
  // Of places only the nodes know, where the contact is.
  const Eigen::Index own = z.size() - 2;
  EXPECT_LT((nlp->pack(nlp->unpack(z)) - z).head(own).cwiseAbs().maxCoeff(), 1e-12);
}

/// A motion in and out again is the same motion.
TEST(Collocation, UnpacksWhatItPacked) {
  const DiscreteProblem discrete = a_step();
  const Trajectory guess = initial_guess(discrete);
  for (const std::string& orientation : orientation_names()) {
    for (const std::string rule : {"trapezoid", "hermite-simpson-separated"}) {
      const auto nlp = make_collocation({.transcription = rule, .orientation = orientation}, discrete, guess);
      const Trajectory back = nlp->unpack(nlp->pack(guess));
      ASSERT_EQ(back.nodes.size(), guess.nodes.size());
      for (std::size_t k = 0; k < back.nodes.size(); ++k) {
        EXPECT_LT(difference(back.nodes[k].q, guess.nodes[k].q).norm(), 1e-12);
        EXPECT_LT((back.nodes[k].v - guess.nodes[k].v).norm(), 1e-12);
        EXPECT_LT((back.nodes[k].a - guess.nodes[k].a).norm(), 1e-12);
        EXPECT_LT((back.nodes[k].tau - guess.nodes[k].tau).norm(), 1e-12);
        EXPECT_NEAR(back.nodes[k].time, guess.nodes[k].time, 1e-12);
      }
    }
  }
}

/// The acceleration that the forward form eliminates is that of the paper's formula, where contacts are not stabilised.
TEST(Collocation, ForwardFormHasThePapersAcceleration) {
  const DiscreteProblem discrete = two_phases();
  const Trajectory guess = initial_guess(discrete);
  const auto nlp = make_collocation({.dynamics = "forward", .contact = "distance"}, discrete, guess);
  std::mt19937 rng(6);
  const Trajectory motion = nlp->unpack(nlp->pack(guess) + test::random_vector(rng, nlp->num_variables(), 0.2));
  for (const TrajectoryPoint& point : motion.nodes) {
    ForwardDynamics dynamics(discrete.problem.robot, point.phase == 0 ? std::vector{0, 1, 2, 3} : std::vector{0, 1, 3});
    dynamics.evaluate(point.q, point.v, point.tau);
    EXPECT_LT((point.a - dynamics.acceleration()).norm(), 1e-9 * dynamics.acceleration().norm());
  }
}

/// HyQ on four feet, a node inside: 36 states and 12 torques, and nothing else but the step that the paper counts with
/// them.
TEST(Collocation, ForwardFormHasThePapersVariables) {
  const DiscreteProblem discrete = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 1.0, 5)}).discrete();
  const auto nlp = make_collocation({.dynamics = "forward", .contact = "distance"}, discrete, initial_guess(discrete));
  EXPECT_EQ(nlp->num_variables(), 6 * 48);
  // Over each interval 36 defects; a node 4 cones, and each but the first 4 distances.
  EXPECT_EQ(nlp->num_constraints(), 5 * 36 + 6 * 4 + 5 * 4);
}

TEST(Collocation, IsThereForEachName) {
  const DiscreteProblem discrete = one_phase();
  const Trajectory guess = initial_guess(discrete);
  const auto make = [&](const Formulation& formulation) { return make_collocation(formulation, discrete, guess); };
  for (const std::string& name : dynamics_names()) EXPECT_TRUE(make({.dynamics = name})) << name;
  for (const std::string& name : transcription_names()) {
    EXPECT_TRUE(make({.dynamics = "forward", .transcription = name})) << name;
  }
  for (const std::string& name : contact_names()) EXPECT_TRUE(make({.contact = name})) << name;
  for (const std::string& name : orientation_names()) EXPECT_TRUE(make({.orientation = name})) << name;
}

TEST(Collocation, RefusesWhatDoesNotGoTogether) {
  const DiscreteProblem discrete = two_phases();
  const Trajectory guess = initial_guess(discrete);
  EXPECT_THROW(make_formulation({.transcription = "rk4"}, discrete, guess), InputError);
  EXPECT_THROW(make_formulation({.transcription = "simpson"}, discrete, guess), InputError);
}

/// The four corners of a flat foot: eight points with 24 rows, 12 of which are new.
TEST(Collocation, TakesContactsThatDependOnEachOtherOnlyStabilisedAndWithoutForces) {
  const DiscreteProblem discrete =
      everything(test::talos(), {phase_on("feet", {0, 1, 2, 3, 4, 5, 6, 7}, 0.1, 1)}).discrete();
  const Trajectory guess = initial_guess(discrete);
  expect_derivatives(discrete, {.orientation = "euler"});
  EXPECT_THROW(make_formulation({.dynamics = "kkt"}, discrete, guess), InputError);
  EXPECT_THROW(make_formulation({.dynamics = "forward", .contact = "distance"}, discrete, guess), InputError);
}

TEST(Collocation, RefusesStepsOfDifferentLength) {
  auto [problem, mesh] = everything(test::hyq(), {phase_on("four", {0, 1, 2, 3}, 0.1, 2)});
  mesh.phases.front() = PhaseMesh({0.25, 0.75});
  const DiscreteProblem discrete(problem, mesh);
  const Trajectory guess = initial_guess(discrete);
  EXPECT_NO_THROW(make_formulation({}, discrete, guess));
  EXPECT_THROW(make_formulation({.dynamics = "forward"}, discrete, guess), InputError);
  EXPECT_THROW(make_formulation({.dynamics = "centroidal"}, discrete, guess), InputError);
}

TEST(Collocation, SaysWhatRowsAndVariablesAre) {
  const DiscreteProblem discrete = a_step();
  const auto nlp =
      make_collocation({.dynamics = "kkt", .transcription = "hermite-simpson"}, discrete, initial_guess(discrete));
  std::vector<std::string> rows, variables;
  for (int i = 0; i < nlp->num_constraints(); ++i) rows.push_back(nlp->describe_constraint(i));
  for (int i = 0; i < nlp->num_variables(); ++i) variables.push_back(nlp->describe_variable(i));
  using testing::Contains;
  using testing::HasSubstr;
  for (const char* what :
       {"phase 1 'four', node 0, t = 0.000 s, lf_foot, acceleration x", "friction cone in the interval",
        "phase 2 'lifted', node 1", "base x, position across the phase transition", "lh_foot, friction cone"}) {
    EXPECT_THAT(rows, Contains(HasSubstr(what)));
  }
  for (const char* what : {"phase 1 'four', duration", "foothold coordinate 2 of lf_foot",
                           "in the interval after it, torque lf_haa_joint", "acceleration base z", "force 12"}) {
    EXPECT_THAT(variables, Contains(HasSubstr(what)));
  }
}

}  // namespace
}  // namespace prowl

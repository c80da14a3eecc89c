#include "prowl/transcription/cost_terms.hpp"

#include <gtest/gtest.h>

#include <set>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/everything_problem.hpp"
#include "tests/support/random_point.hpp"
#include "tests/support/robots.hpp"
#include "tests/support/terms_problem.hpp"

namespace prowl {
namespace {

/// A problem with every kind of cost, free durations and feet that lift and land, at a point that is no solution.
struct Case {
  Case()
      : Case(test::everything(test::hyq(),
                              {test::free_phase("four", {0, 1, 2, 3}, 4), test::phase_on("lifted", {1, 2, 3}, 0.2, 2),
                               test::free_phase("landed", {0, 1, 2, 3}, 2)})) {}
  explicit Case(test::MeshedProblem of) : problem(std::move(of.problem)), mesh(std::move(of.mesh)) {
    problem.running_cost.time_weight = 2.3;
    problem.terms = test::every_term(problem.robot, "lf_foot", "rh_upperleg", 3);
  }

  MotionProblem problem;
  Mesh mesh;
};

TEST(CostTerms, AddUpToTheCostOfTheTranscription) {
  const Case test;
  const DiscreteProblem discrete(test.problem, test.mesh);
  const Trajectory guess = initial_guess(discrete);
  Transcription nlp(discrete, guess);
  std::mt19937 rng(11);
  const Eigen::VectorXd z = nlp.pack(guess) + test::random_vector(rng, nlp.num_variables(), 0.1);
  double sum = 0.0;
  std::set<std::string> keys;
  for (const CostTerm& term : cost_terms(test.problem, nlp.unpack(z))) {
    EXPECT_GT(term.cost, 0.0) << term.key;
    EXPECT_TRUE(keys.insert(term.key).second) << term.key << " is there twice";
    sum += term.cost;
  }
  EXPECT_NEAR(sum, nlp.cost(z), 1e-12 * sum);
  EXPECT_GE(keys.size(), 18u) << "the problem lacks kinds of cost, so the test checks too little";
}

TEST(CostTerms, AreLeftOutWithoutAWeight) {
  Case test;
  test.problem.running_cost.torque_weight.setZero();
  test.problem.running_cost.time_weight = 0.0;
  test.problem.terminal_cost.contact_positions.clear();
  const DiscreteProblem discrete(test.problem, test.mesh);
  const Trajectory motion = initial_guess(discrete);
  std::set<std::string> keys;
  for (const CostTerm& term : cost_terms(test.problem, motion)) keys.insert(term.key);
  EXPECT_EQ(keys.count("torque") + keys.count("time") + keys.count("terminal_cost.contact_position"), 0u);
  EXPECT_EQ(keys.count("contact_position"), 1u);
}

TEST(CostTerms, HaveTheirRateAtEveryNode) {
  const Case test;
  const DiscreteProblem discrete(test.problem, test.mesh);
  const Trajectory motion = initial_guess(discrete);
  int terminal = 0;
  for (const CostTerm& term : cost_terms(test.problem, motion)) {
    ASSERT_EQ(term.rate.size(), discrete.num_nodes()) << term.key;
    if (term.key == "time") EXPECT_NEAR(term.cost, 2.3 * motion.duration(), 1e-12);
    if (!term.key.starts_with("terminal_cost.")) continue;
    ++terminal;
    EXPECT_TRUE(term.rate.isZero(0.0)) << term.key;
  }
  EXPECT_GT(terminal, 0);
}

TEST(CostTerms, OfNoMotionAreNone) { EXPECT_TRUE(cost_terms(Case().problem, {}).empty()); }

}  // namespace
}  // namespace prowl

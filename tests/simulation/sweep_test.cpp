#include "prowl/simulation/sweep.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "prowl/simulation/perturbations.hpp"
#include "tests/simulation/standing_tracker.hpp"

namespace prowl {
namespace {

/// Clopper and Pearson's bounds p are where the binomial tail from the outcome on has 2.5 %.
TEST(SuccessRate, BoundsCutOffTheTails) {
  const auto tail = [](int cases, int from, double p) {  // P(X >= from)
    double sum = 0.0;
    for (int k = from; k <= cases; ++k) {
      sum += std::exp(std::lgamma(cases + 1) - std::lgamma(k + 1) - std::lgamma(cases - k + 1) + k * std::log(p) +
                      (cases - k) * std::log1p(-p));
    }
    return sum;
  };
  for (const int successes : {1, 10, 100, 195, 199}) {
    const SuccessRate rate = success_rate(successes, 200);
    EXPECT_NEAR(tail(200, successes, rate.lower), 0.025, 1e-6) << successes;
    EXPECT_NEAR(1.0 - tail(200, successes + 1, rate.upper), 0.025, 1e-6) << successes;
  }
  EXPECT_EQ(success_rate(0, 200).lower, 0.0);
  EXPECT_EQ(success_rate(200, 200).upper, 1.0);
}

/// A case of a sweep is what simulate() makes of it, and all of them are there, in order.
TEST(Sweep, CasesCanBeReplayed) {
  MotionProblem problem = test::standing_problem();
  problem.phases.front().duration = {0.3, 0.3};
  const Tracker tracker = test::standing_tracker(problem);
  const SuccessCriteria criteria{.rest = 0.3};
  std::vector<SimulationOptions> options;
  for (std::uint64_t seed = 1; seed <= 6; ++seed) options.push_back(perturbed(problem, tracker, {}, {}, seed));
  int last = -1;
  const auto cases = run_cases(
      problem, tracker, criteria, options,
      [&](int done, int total) {
        EXPECT_EQ(done, ++last);
        EXPECT_EQ(total, 6);
      },
      nullptr);
  ASSERT_EQ(cases.size(), 6u);
  for (std::size_t i = 0; i < 6; ++i) {
    const SimulationResult again = simulate(problem, tracker, criteria, options[i]);
    EXPECT_EQ(cases[i].result.base_position.largest, again.base_position.largest);
    EXPECT_EQ(cases[i].result.positive_work, again.positive_work);
  }
  EXPECT_NE(cases[0].result.positive_work, cases[1].result.positive_work);
  EXPECT_EQ(last, 6);
  const std::atomic<bool> stop = true;
  EXPECT_TRUE(run_cases(problem, tracker, criteria, options, {}, &stop).empty());
}

class Interrupted : public testing::Test {
 protected:
  static MotionProblem short_problem() {
    MotionProblem problem = test::standing_problem();
    problem.phases.front().duration = {0.1, 0.1};
    return problem;
  }
  MotionProblem problem_ = short_problem();
  Tracker tracker_ = test::standing_tracker(problem_);
  SuccessCriteria criteria_{.rest = 0.1};
};

/// What had begun is finished and kept: the first cases, without gaps, each as without an interrupt.
TEST_F(Interrupted, KeepsTheCasesThatHadBegun) {
  std::vector<SimulationOptions> options;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) options.push_back(perturbed(problem_, tracker_, {}, {}, seed));
  std::atomic<bool> stop = false;
  int told = 0;
  const auto cases = run_cases(
      problem_, tracker_, criteria_, options,
      [&](int done, int) {
        told = done;
        if (done >= 3) stop = true;
      },
      &stop);
  EXPECT_GE(cases.size(), 3u);
  EXPECT_LT(cases.size(), 200u);
  EXPECT_EQ(static_cast<int>(cases.size()), told) << "a case that was finished is missing";
  for (std::size_t i = 0; i < cases.size(); ++i) EXPECT_EQ(cases[i].options.seed, options[i].seed);
}

/// Progress goes up to what it said at first, whatever sizes are left out; a kind that is not found is not there.
TEST_F(Interrupted, LeavesOutKindsThatAreNotFound) {
  int last = -1, most = 0;
  const auto all = find_breakdowns(
      problem_, tracker_, criteria_, {}, 1, 1,
      [&](int done, int total) {
        EXPECT_GE(done, last);
        if (last >= 0) EXPECT_EQ(total, most);
        last = done;
        most = total;
      },
      nullptr);
  ASSERT_EQ(all.size(), 6u);
  EXPECT_EQ(last, most);

  for (const int after : {1, most / 2, most}) {
    std::atomic<bool> stop = false;
    const auto some = find_breakdowns(
        problem_, tracker_, criteria_, {}, 1, 1, [&](int done, int) { stop = stop || done >= after; }, &stop);
    EXPECT_LT(some.size(), 6u + (after == most ? 1u : 0u));
    for (std::size_t i = 0; i < some.size(); ++i) {
      EXPECT_EQ(some[i].kind, all[i].kind);
      EXPECT_EQ(some[i].holds, all[i].holds);
      EXPECT_EQ(some[i].fails, all[i].fails);
    }
    if (after == 1) EXPECT_TRUE(some.empty());
    if (after == most / 2) EXPECT_FALSE(some.empty());
  }
}

}  // namespace
}  // namespace prowl

// Solo12 asked to stretch its legs, and beyond, in the middle of a motion: where they can no longer move the base, and
// Newton's equations become singular. Every solver ends in time and says where it was, or gives a motion whose
// certificate tells the truth.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

/// Up by `rise` [m] after one second, and down again. The legs are straight at 0.0985 m, and no limit keeps them from
/// it.
DiscreteProblem stretch(double rise) {
  RobotDescription description = test::solo12_description();
  description.limits.clear();
  MotionProblem problem = test::with_base_goal(test::standing_problem(RobotModel(description)), {0.0, 0.0, rise});
  problem.boundary_constraints.back().at.fraction = 0.5;
  problem.running_cost.velocity_weight.tail(problem.robot.nu()).setConstant(0.1);
  problem.running_cost.acceleration_weight.setConstant(0.01);
  return test::on_even_mesh(std::move(problem), 16);
}

std::string all_words(const Plan& plan) {
  std::string words = plan.result.message;
  for (const auto& lines : {plan.reasons, plan.hints}) {
    for (const std::string& line : lines) words += "\n" + line;
  }
  return words;
}

class Stretch : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(By, Stretch, testing::Values("riccati", "fatrop", "ipopt"));

TEST_P(Stretch, IsSolvedOrExplainedAndNeverClaimed) {
  const IpoptSolver elastic_solver;
  constexpr double kMostSeconds = 5.0;
  for (const double rise : {0.05, 0.09, 0.0985, 0.105, 0.15}) {
    const Plan plan = make_plan(stretch(rise), *make_solver(GetParam()),
                                {.solver = {.max_iterations = 100, .max_seconds = kMostSeconds},
                                 .elastic_solver = [&] { return &elastic_solver; }});
    const std::string words = std::to_string(rise) + " m: " + to_string(plan.result.status) + ", " + all_words(plan);
    EXPECT_LT(plan.result.seconds, 2.0 * kMostSeconds) << words;
    EXPECT_TRUE(plan.result.z.allFinite()) << words;
    if (rise < 0.06) {
      EXPECT_EQ(plan.result.status, SolveStatus::converged) << words;
    } else if (rise > 0.1) {  // out of reach: what a solver may find breaks the contacts between the nodes
      EXPECT_FALSE(plan.certificate.passed) << words;
    }
    if (plan.result.status == SolveStatus::converged) {
      EXPECT_LE(plan.result.constraint_violation, 1e-6) << words;
    } else {
      EXPECT_THAT(words, AnyOf(HasSubstr("phase 'stand'"), HasSubstr("phase 1"))) << "it does not say where";
    }
  }
}

}  // namespace
}  // namespace prowl

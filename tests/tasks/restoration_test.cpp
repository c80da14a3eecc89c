// What make_plan() does where the solver ends without a solution: it says which limits conflict, or finds that none
// does and solves again.
#include <gmock/gmock.h>

#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

const IpoptSolver& ipopt() {
  static const IpoptSolver solver;
  return solver;
}

/// HyQ moves its base forward by so much, from rest to rest in `seconds`.
DiscreteProblem forward(double way, double seconds, double friction) {
  MotionProblem problem = test::with_base_goal(test::standing_problem(test::hyq(), 0.0, friction), {way, 0.0, 0.0});
  problem.phases.front().duration = {seconds, seconds};
  problem.running_cost.acceleration_weight.setOnes();
  BoundaryConstraint& goal = problem.boundary_constraints.back();
  goal.velocity_lower.head<6>().setZero();
  goal.velocity_upper.head<6>().setZero();
  return test::on_even_mesh(std::move(problem), 8);
}

Plan planned(const DiscreteProblem& problem, const NlpSolver& solver, SolverOptions options = {}) {
  return make_plan(problem, solver, {.solver = std::move(options), .elastic_solver = [] { return &ipopt(); }});
}

TEST(Restoration, NamesTheLimitsThatConflict) {
  const Plan plan = planned(forward(0.1, 0.2, 0.5), RiccatiSolver());
  EXPECT_EQ(plan.result.status, SolveStatus::infeasible);
  EXPECT_THAT(plan.result.message, HasSubstr("no motion nearby keeps all limits on 8 mesh intervals"));
  ASSERT_FALSE(plan.hints.empty());
  EXPECT_THAT(plan.hints.front(), StartsWith("has to give way: phase 1"));
  EXPECT_FALSE(plan.certificate.passed);
}

/// The same way in ten times the time: nothing to name.
TEST(Restoration, LeavesASolutionAlone) {
  const Plan plan = planned(forward(0.1, 2.0, 0.5), RiccatiSolver());
  EXPECT_EQ(plan.result.status, SolveStatus::converged);
  EXPECT_TRUE(plan.hints.empty());
}

/// A solver that ends without a solution the first time that it runs.
class FailsOnce : public RiccatiSolver {
 public:
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override {
    if (runs_++ > 0) return RiccatiSolver::solve(nlp, z_guess, options);
    SolverOptions short_of = options;
    short_of.max_iterations = 1;
    SolveResult result = RiccatiSolver::solve(nlp, z_guess, short_of);
    result.status = SolveStatus::solver_failed;
    return result;
  }

 private:
  mutable int runs_ = 0;
};

TEST(Restoration, SolvesAgainFromAMotionThatKeepsAllLimits) {
  const DiscreteProblem problem = forward(0.1, 2.0, 0.5);
  const Plan direct = planned(problem, RiccatiSolver()), restored = planned(problem, FailsOnce());
  EXPECT_EQ(restored.result.status, SolveStatus::converged);
  EXPECT_TRUE(restored.hints.empty());
  EXPECT_EQ(restored.levels.size(), 2u);
  EXPECT_NEAR(restored.result.cost, direct.result.cost, 1e-5 * direct.result.cost);
}

TEST(Restoration, NeedsASolverForIt) {
  const Plan plan = make_plan(forward(0.1, 0.2, 0.5), RiccatiSolver(), {});
  EXPECT_NE(plan.result.status, SolveStatus::converged);
  EXPECT_THAT(plan.hints, Each(Not(HasSubstr("has to give way"))));
}

}  // namespace
}  // namespace prowl

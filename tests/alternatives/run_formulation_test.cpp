#include "alternatives/run_formulation.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "prowl/error.hpp"
#include "prowl/plan.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "prowl/transcription/transcription.hpp"
#include "tests/support/meshed_problem.hpp"
#include "tests/support/standing_problem.hpp"

namespace prowl {
namespace {

/// HyQ moves its base by 5 cm with little torque.
DiscreteProblem shift() {
  MotionProblem problem = test::with_base_goal(test::standing_problem(), {0.05, 0.0, -0.02});
  problem.running_cost.torque_weight.setConstant(1e-3);
  problem.running_cost.velocity_weight.setConstant(1e-1);
  return test::on_even_mesh(std::move(problem), 8);
}

TEST(RunFormulation, OfTheDefaultIsWhatMakePlanDoes) {
  const DiscreteProblem discrete = shift();
  const FormulationRun run = run_formulation(discrete, {}, RiccatiSolver(), {});
  const Plan plan = make_plan(discrete, RiccatiSolver(), {.coarse_first = false});
  ASSERT_EQ(run.result.status, SolveStatus::converged) << run.result.message;
  EXPECT_EQ(run.result.cost, plan.result.cost);
  EXPECT_EQ(run.result.iterations, plan.result.iterations);
  EXPECT_EQ(run.num_variables, plan.num_variables);
  EXPECT_EQ(run.num_constraints, plan.num_constraints);
  EXPECT_EQ(run.nodes, 9);
  ASSERT_EQ(run.certificate.checks.size(), plan.certificate.checks.size());
  for (std::size_t i = 0; i < plan.certificate.checks.size(); ++i) {
    EXPECT_EQ(run.certificate.checks[i].worst, plan.certificate.checks[i].worst) << plan.certificate.checks[i].name;
  }
  EXPECT_GT(run.contacts.velocity, 0.0);
  EXPECT_GT(run.contacts.acceleration, 0.0);
  EXPECT_LE(run.contacts.velocity, run.certificate.find("contact velocity")->worst + 1e-12)
      << "which is that of the nodes, too";
  EXPECT_EQ(run.certificate.find("contact drift")->name, "contact drift");
  EXPECT_EQ(run.certificate.find("swing clearance missing"), nullptr) << "nothing swings";
}

TEST(RunFormulation, TakesTheHessianThatIsAskedFor) {
  const DiscreteProblem discrete = shift();
  const SolverOptions options{.max_iterations = 500};
  const FormulationRun exact = run_formulation(discrete, {}, IpoptSolver(), options);
  const FormulationRun other = run_formulation(discrete, {}, IpoptSolver(), options, HessianKind::gauss_newton);
  ASSERT_EQ(exact.result.status, SolveStatus::converged);
  ASSERT_EQ(other.result.status, SolveStatus::converged);
  EXPECT_NE(exact.result.iterations, other.result.iterations);
  EXPECT_NEAR(other.result.cost, exact.result.cost, 1e-6 * exact.result.cost);
}

TEST(RunFormulation, RefusesWhatThereIsNot) {
  EXPECT_THROW(run_formulation(shift(), {.dynamics = "magic"}, RiccatiSolver(), {}), InputError);
}

TEST(ShareOfLimit, OrdersAllChecks) {
  const auto share = [](double worst, double limit) { return share_of_limit({.worst = worst, .limit = limit}); };
  EXPECT_EQ(share(2.0, 4.0), 0.5);
  EXPECT_EQ(share(-2.0, 4.0), -0.5);
  EXPECT_EQ(share(0.0, 0.0), 0.0) << "the nodes fit the problem";
  EXPECT_EQ(share(1.0, 0.0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(share(std::numeric_limits<double>::quiet_NaN(), 1.0), std::numeric_limits<double>::infinity());
}

TEST(FormulationRun, KnowsItsWorstCheck) {
  FormulationRun run = run_formulation(shift(), {}, RiccatiSolver(), {.max_iterations = 1});
  ASSERT_EQ(run.certificate.checks.front().limit, 0.0) << "or the test does not have the awkward one in it";
  const CertificateCheck* const worst = run.worst_check();
  ASSERT_NE(worst, nullptr);
  for (const CertificateCheck& check : run.certificate.checks)
    EXPECT_LE(share_of_limit(check), share_of_limit(*worst)) << check.name;
  EXPECT_FALSE(worst->passed) << "one iteration is not enough";
  run.certificate.checks.push_back(
      {.name = "unknown", .worst = std::numeric_limits<double>::quiet_NaN(), .limit = 1.0});
  EXPECT_EQ(run.worst_check()->name, "unknown");
  run.certificate.checks.clear();
  EXPECT_EQ(run.worst_check(), nullptr);
}

}  // namespace
}  // namespace prowl

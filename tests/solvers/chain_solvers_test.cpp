// Laws of the solvers that go through a chain of stages.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <thread>

#include "prowl/error.hpp"
#include "prowl/solvers/foreign/fatrop_solver.hpp"
#include "prowl/solvers/foreign/ipopt_solver.hpp"
#include "prowl/solvers/riccati/riccati_solver.hpp"
#include "tests/solvers/cart.hpp"

namespace prowl {
namespace {

using test::Cart;
using test::CartTask;
using ::testing::AllOf;
using ::testing::AnyOf;
using ::testing::HasSubstr;

template <class Solver>
class ChainSolvers : public ::testing::Test {
 protected:
  static SolveResult solve(Cart& cart, const SolverOptions& options = {}) {
    return Solver().solve(cart, Cart::zeros(), options);
  }
};
using Solvers = ::testing::Types<FatropSolver, RiccatiSolver>;
struct Names {
  template <class Solver>
  static std::string GetName(int) {
    return Solver().name();
  }
};
TYPED_TEST_SUITE(ChainSolvers, Solvers, Names);

TYPED_TEST(ChainSolvers, FindWhatIpoptFinds) {
  Cart cart;
  const SolverOptions options{.tolerance = 1e-9};
  const SolveResult found = this->solve(cart, options);
  const SolveResult ipopt = IpoptSolver().solve(cart, Cart::zeros(), options);
  ASSERT_EQ(found.status, SolveStatus::converged) << found.message;
  ASSERT_EQ(ipopt.status, SolveStatus::converged) << ipopt.message;
  EXPECT_LT((found.z - ipopt.z).cwiseAbs().maxCoeff(), 1e-6);
  EXPECT_NEAR(found.cost, ipopt.cost, 1e-8);
  EXPECT_LT(found.constraint_violation, 1e-9);
  EXPECT_LT(found.dual_violation, 1e-8);
  EXPECT_NEAR(found.z(0), CartTask().most, 1e-4) << "no limit is active, so that nothing tests them";
}

TYPED_TEST(ChainSolvers, FindTheSameFromNear) {
  Cart cart;
  const SolveResult first = this->solve(cart);
  ASSERT_EQ(first.status, SolveStatus::converged) << first.message;
  const SolveResult again = TypeParam().solve(cart, first.z, {.is_warm_start = true});
  ASSERT_EQ(again.status, SolveStatus::converged) << again.message;
  EXPECT_LT(again.iterations, first.iterations);
  EXPECT_NEAR(again.cost, first.cost, 1e-5);
}

/// Tells who evaluates it; stands one thread, as an Nlp that says nothing of threads.
class WatchedCart : public Cart {
 public:
  using Cart::Cart;
  std::set<std::thread::id> seen;  // without a lock: all this is about one thread
  const StageValues& values(int k, const Eigen::VectorXd& ux) override {
    seen.insert(std::this_thread::get_id());
    return Cart::values(k, ux);
  }
};

TEST(RiccatiSolver, GivesNoMoreThreadsThanAProgramStands) {
  WatchedCart cart;
  const SolveResult result = RiccatiSolver().solve(cart, Cart::zeros(), {.threads = 4});
  EXPECT_EQ(result.status, SolveStatus::converged) << result.message;
  EXPECT_EQ(cart.seen, std::set{std::this_thread::get_id()});
}

TYPED_TEST(ChainSolvers, DoTheSameTwice) {
  Cart one, two;
  const SolveResult first = this->solve(one), second = this->solve(two), third = this->solve(one);
  ASSERT_EQ(first.status, SolveStatus::converged) << first.message;
  EXPECT_EQ(first.z, second.z);
  EXPECT_EQ(first.z, third.z);
  EXPECT_EQ(first.iterations, second.iterations);
}

TYPED_TEST(ChainSolvers, ShowTheIteratesThatTheyTellOf) {
  Cart cart, other;
  std::vector<Eigen::VectorXd> iterates;
  int calls = 0;
  double cost = 0.0;
  SolverOptions options;
  options.max_iterations = 3;
  options.on_iteration = [&](const SolveProgress& progress) {
    ++calls;
    cost = progress.cost;
  };
  options.on_iterate = [&](const Eigen::VectorXd& z) {
    EXPECT_NEAR(other.cost(z), cost, 1e-9 * (1.0 + std::abs(cost))) << calls;
    iterates.push_back(z);
  };
  const SolveResult result = this->solve(cart, options);
  ASSERT_EQ(static_cast<int>(iterates.size()), calls);
  EXPECT_EQ(calls, 4);
  EXPECT_TRUE(std::find(iterates.begin(), iterates.end(), result.z) != iterates.end())
      << "stopped, it gives back the best of them";
  EXPECT_NE(iterates.front(), iterates.back());
}

TYPED_TEST(ChainSolvers, TellEveryIteration) {
  Cart cart;
  int calls = 0;
  double violation = 0.0;
  SolverOptions options;
  options.on_iteration = [&](const SolveProgress& progress) {
    EXPECT_EQ(progress.iteration, calls++);
    violation = progress.constraint_violation;
    if (calls == 1) EXPECT_NEAR(violation, CartTask().goal, 1e-12) << "at the start only the goal is missed";
  };
  const SolveResult result = this->solve(cart, options);
  EXPECT_EQ(result.status, SolveStatus::converged);
  EXPECT_EQ(calls, result.iterations);
  EXPECT_LT(violation, 1e-2);
}

TYPED_TEST(ChainSolvers, StopAtTheLimitOfIterations) {
  for (const int limit : {0, 1, 3}) {
    Cart cart;
    const SolveResult result = this->solve(cart, {.max_iterations = limit});
    EXPECT_EQ(result.status, SolveStatus::iteration_limit);
    EXPECT_EQ(result.iterations, limit);
    EXPECT_EQ(result.z.size(), cart.num_variables());
  }
}

TYPED_TEST(ChainSolvers, StopWhenTheTimeIsUp) {
  Cart cart;
  EXPECT_EQ(this->solve(cart, {.max_seconds = 1e-9}).status, SolveStatus::time_limit);
}

TYPED_TEST(ChainSolvers, StopOnRequest) {
  Cart cart;
  std::atomic<bool> stop = false;
  SolverOptions options{.interrupt = &stop};
  options.on_iteration = [&](const SolveProgress& progress) { stop = progress.iteration == 2; };
  const SolveResult result = this->solve(cart, options);
  EXPECT_EQ(result.status, SolveStatus::interrupted);
  EXPECT_EQ(result.iterations, 2);
  EXPECT_EQ(result.z.size(), cart.num_variables());
}

TYPED_TEST(ChainSolvers, EndWhereTheGuessIsNaN) {
  Cart cart;
  cart.nan_below = 0.1;
  const SolveResult result = this->solve(cart);
  EXPECT_EQ(result.status, SolveStatus::evaluation_failed);
  EXPECT_THAT(result.message, AllOf(HasSubstr("not finite"), HasSubstr("stage 0")));
}

TYPED_TEST(ChainSolvers, EndWhereDerivativesAreNaN) {
  using enum Cart::Derivative;
  for (const auto derivative : {of_cost, of_next, of_inequalities, second}) {
    Cart cart;
    cart.nan_in = derivative;
    cart.nan_after = 3 * Cart::kSteps + 4;
    const SolveResult result = this->solve(cart);
    EXPECT_EQ(result.status, SolveStatus::evaluation_failed) << static_cast<int>(derivative) << ": " << result.message;
    EXPECT_THAT(result.message, HasSubstr("not finite"));
    EXPECT_TRUE(result.z.allFinite());
  }
}

TYPED_TEST(ChainSolvers, NameBoundsThatLeaveNothing) {
  for (const CartTask& task : {CartTask{.least = 1.0, .most = -1.0}, CartTask{.least = NAN}}) {
    Cart cart(task);
    EXPECT_THAT(TypeParam().why_unsupported(cart).value_or(""), HasSubstr("contain no interior"));
    const SolveResult result = this->solve(cart);
    EXPECT_EQ(result.status, SolveStatus::solver_failed);
    EXPECT_THAT(result.message, HasSubstr("stage 0: bounds ["));
  }
}

/// Full force all the way does not go so far.
TYPED_TEST(ChainSolvers, EndWhereThereIsNoSolution) {
  Cart cart({.goal = 10.0});
  const SolveResult result = this->solve(cart, {.max_iterations = 1000});
  EXPECT_THAT(result.status, AnyOf(SolveStatus::infeasible, SolveStatus::solver_failed)) << result.message;
  EXPECT_LT(result.iterations, 1000);
  EXPECT_GT(result.constraint_violation, 0.1);
}

/// The greater the forces the better, and nothing bounds them.
TYPED_TEST(ChainSolvers, EndWhereTheCostHasNoLeast) {
  Cart cart({.least = -INFINITY, .most = INFINITY, .curvature = -1.0});
  const SolveResult result = this->solve(cart, {.max_iterations = 1000});
  EXPECT_NE(result.status, SolveStatus::converged) << result.message;
  EXPECT_TRUE(result.z.allFinite());
}

TYPED_TEST(ChainSolvers, TakeChainsOnly) {
  test::Hs071 nlp;
  EXPECT_THAT(TypeParam().why_unsupported(nlp).value_or(""), HasSubstr("chain of stages"));
  EXPECT_EQ(TypeParam().solve(nlp, test::Hs071::guess(), {}).status, SolveStatus::solver_failed);
  Cart cart;
  EXPECT_EQ(TypeParam().why_unsupported(cart), std::nullopt);
}

TYPED_TEST(ChainSolvers, RefuseAGuessOfTheWrongSize) {
  Cart cart;
  EXPECT_THROW(TypeParam().solve(cart, Eigen::VectorXd::Zero(3), {}), InputError);
}

}  // namespace
}  // namespace prowl

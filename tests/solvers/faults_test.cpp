// What every solver does when a function of the problem fails: gives NaN or infinity, or throws, from its first, third,
// ... evaluation on, for good or once. It must end, say what failed where, and never call that solved.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>
#include <string>
#include <tuple>

#include "prowl/error.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "tests/solvers/cart.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using test::Cart;
using ::testing::AnyOf;
using ::testing::HasSubstr;

enum class Function { cost, gradient, constraints, jacobian, hessian };
enum class Kind { nan, infinity, numerical_error, logic_error, no_exception };

struct Fault {
  Function function = Function::cost;
  Kind kind = Kind::nan;
  int first = 1;  ///< evaluation that fails
  bool for_good = true;
};

/// The cart with a fault, in stage 7 for solvers that go by stages.
class FaultyCart : public Cart {
 public:
  explicit FaultyCart(const Fault& fault) : fault_(fault) {}
  int failed = 0;  ///< evaluations

  double cost(const VectorXd& z) override { return Cart::cost(z) + fault(Function::cost); }
  void cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) override {
    Cart::cost_gradient(z, gradient);
    gradient(3 * kStage) += fault(Function::gradient);
  }
  void constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) override {
    Cart::constraints(z, g);
    g(2 * kStage) += fault(Function::constraints);
  }
  void jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) override {
    Cart::jacobian(z, values);
    values(60) += fault(Function::jacobian);
  }
  void hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
               Eigen::Ref<VectorXd> values) override {
    Cart::hessian(z, cost_factor, multipliers, values);
    values(3 * kStage) += fault(Function::hessian);
  }
  const StageValues& values(int k, const VectorXd& ux) override {
    stage_values_ = Cart::values(k, ux);
    if (k == kStage) stage_values_.cost += fault(Function::cost);
    if (k == kStage) stage_values_.next(0) += fault(Function::constraints);
    return stage_values_;
  }
  const StageDerivatives& derivatives(int k, const VectorXd& ux) override {
    stage_derivatives_ = Cart::derivatives(k, ux);
    if (k == kStage) stage_derivatives_.cost_gradient(0) += fault(Function::gradient);
    if (k == kStage) stage_derivatives_.next(1, 0) += fault(Function::jacobian);
    return stage_derivatives_;
  }
  const Eigen::MatrixXd& hessian(int k, const VectorXd& ux, double cost_factor, const StageMultipliers& on) override {
    stage_hessian_ = Cart::hessian(k, ux, cost_factor, on);
    if (k == kStage) stage_hessian_(0, 0) += fault(Function::hessian);
    return stage_hessian_;
  }

 private:
  static constexpr int kStage = 7;

  double fault(Function here) {
    if (here != fault_.function) return 0.0;
    ++evaluations_;
    if (evaluations_ < fault_.first || (!fault_.for_good && evaluations_ > fault_.first)) return 0.0;
    ++failed;
    switch (fault_.kind) {
      case Kind::nan: return NAN;
      case Kind::infinity: return INFINITY;
      case Kind::numerical_error: throw NumericalError("contacts are singular");
      case Kind::logic_error: throw std::logic_error("a mistake");
      case Kind::no_exception: throw 7;
    }
    return 0.0;
  }

  Fault fault_;
  int evaluations_ = 0;
  StageValues stage_values_;
  StageDerivatives stage_derivatives_;
  Eigen::MatrixXd stage_hessian_;
};

constexpr Function kFunctions[] = {Function::cost, Function::gradient, Function::constraints, Function::jacobian,
                                   Function::hessian};
const char* const kNames[] = {"cost", "gradient", "constraints", "jacobian", "hessian"};

std::string name_of(std::string solver) {
  std::erase(solver, '-');
  return solver;
}

class Faults : public ::testing::TestWithParam<std::tuple<std::string, Function>> {
 protected:
  std::string solver() const { return std::get<0>(GetParam()); }
  bool by_stages() const { return solver() == "riccati" || solver() == "fatrop"; }
  Fault fault(Kind kind, int first, bool for_good) const { return {std::get<1>(GetParam()), kind, first, for_good}; }
  static SolveResult solve(Nlp& nlp, const std::string& solver) {
    return make_solver(solver)->solve(nlp, Cart::zeros(), {.max_iterations = 200, .max_seconds = 20.0});
  }
  SolveResult solve(Nlp& nlp) const { return solve(nlp, solver()); }
};
INSTANTIATE_TEST_SUITE_P(All, Faults,
                         ::testing::Combine(::testing::ValuesIn(solver_names()), ::testing::ValuesIn(kFunctions)),
                         [](const auto& info) {
                           return name_of(std::get<0>(info.param)) + "_" +
                                  kNames[static_cast<int>(std::get<1>(info.param))];
                         });

TEST_P(Faults, AreNamedWithTheirRowAndVariable) {
  for (const Kind kind : {Kind::nan, Kind::infinity, Kind::numerical_error}) {
    FaultyCart cart(fault(kind, 1, true));
    const SolveResult result = solve(cart);
    EXPECT_EQ(result.status, SolveStatus::evaluation_failed) << result.message;
    if (kind == Kind::numerical_error) {
      EXPECT_THAT(result.message, HasSubstr("contacts are singular"));
    } else {
      EXPECT_THAT(result.message, AnyOf(HasSubstr("nan"), HasSubstr("inf"), HasSubstr("not finite")));
    }
    if (by_stages()) {
      EXPECT_THAT(result.message, HasSubstr("stage 7"));
    } else if (kind != Kind::numerical_error && std::get<1>(GetParam()) != Function::cost) {
      EXPECT_THAT(result.message, AnyOf(HasSubstr("variable "), HasSubstr("constraint ")));
    }
    EXPECT_EQ(result.z.size(), cart.num_variables());
    EXPECT_TRUE(result.z.allFinite());
  }
}

/// Whatever is thrown that is no NumericalError is a mistake, which no shorter step will help.
TEST_P(Faults, ThatAreMistakesEndTheSolve) {
  for (const Kind kind : {Kind::logic_error, Kind::no_exception}) {
    for (const int first : {1, 4}) {
      FaultyCart cart(fault(kind, first, true));
      const SolveResult result = solve(cart);
      if (first > 1 && cart.failed == 0) continue;  // done before: Uno needs few derivatives here
      EXPECT_EQ(result.status, SolveStatus::solver_failed) << result.message;
      EXPECT_THAT(result.message, HasSubstr(kind == Kind::logic_error ? "a mistake" : "not a std::exception"));
      EXPECT_TRUE(result.z.size() == cart.num_variables() && result.z.allFinite());
      EXPECT_LE(cart.failed, 2) << "evaluated again and again";
    }
  }
}

TEST_P(Faults, ThatComeLateEndTheSolve) {
  int late = 0;
  for (const Kind kind : {Kind::nan, Kind::infinity, Kind::numerical_error}) {
    for (const int first : {2, 3, 5}) {
      FaultyCart cart(fault(kind, first, true));
      const SolveResult result = solve(cart);
      if (cart.failed == 0) continue;  // done before: Uno needs few derivatives here
      ++late;
      EXPECT_EQ(result.status, SolveStatus::evaluation_failed)
          << "kind " << static_cast<int>(kind) << ", from " << first << ": " << result.message;
      EXPECT_TRUE(result.z.size() == cart.num_variables() && result.z.allFinite());
      if (by_stages()) EXPECT_THAT(result.message, HasSubstr("stage 7"));
    }
  }
  EXPECT_GT(late, 0) << "it never comes, so the test checks nothing";
}

/// They may get away from it by a shorter step; then the result is as good as ever.
TEST_P(Faults, ThatComeOnceEndTheSolveOrDoNoHarm) {
  Cart sound;
  const SolveResult truth = solve(sound);
  ASSERT_EQ(truth.status, SolveStatus::converged) << truth.message;
  for (const Kind kind : {Kind::nan, Kind::infinity, Kind::numerical_error}) {
    for (const int first : {2, 3, 5, 8}) {
      FaultyCart cart(fault(kind, first, false));
      const SolveResult result = solve(cart);
      EXPECT_THAT(result.status, AnyOf(SolveStatus::converged, SolveStatus::evaluation_failed)) << result.message;
      if (result.status != SolveStatus::converged) continue;
      VectorXd rows(sound.num_constraints());
      sound.constraints(result.z, rows);
      EXPECT_LT(constraint_violation(sound, result.z, rows), 1e-6);
      EXPECT_NEAR(result.cost, truth.cost, 1e-5);
    }
  }
}

}  // namespace
}  // namespace prowl

#include "prowl/solvers/guarded_nlp.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "prowl/error.hpp"
#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// HS071 with a fault, put where a test wants it.
struct Faulty : test::Hs071 {
  double cost_error = 0.0;
  int nan_constraint = -1, nan_jacobian = -1, nan_hessian = -1;
  bool throw_numerical = false, throw_logic = false, throw_int = false;

  double cost(const Eigen::VectorXd& x) override { return Hs071::cost(x) + cost_error; }
  void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> g) override {
    if (throw_numerical) throw NumericalError("contact Jacobian of phase 1 is singular");
    if (throw_logic) throw std::logic_error("a mistake");
    if (throw_int) throw 7;
    Hs071::constraints(x, g);
    if (nan_constraint >= 0) g[nan_constraint] = NAN;
  }
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    Hs071::jacobian(x, values);
    if (nan_jacobian >= 0) values[nan_jacobian] = INFINITY;
  }
  void hessian(const Eigen::VectorXd& x, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    Hs071::hessian(x, cost_factor, multipliers, values);
    if (nan_hessian >= 0) values[nan_hessian] = NAN;
  }
};

class GuardedNlpTest : public ::testing::Test {
 protected:
  Faulty nlp_;
  GuardedNlp guarded_{nlp_};
  const Eigen::VectorXd z_ = test::Hs071::guess();
  const Eigen::VectorXd multipliers_ = Eigen::Vector2d(1.0, 1.0);
  Eigen::VectorXd g_ = Eigen::VectorXd(2), jacobian_ = Eigen::VectorXd(8), hessian_ = Eigen::VectorXd(10);
};

TEST_F(GuardedNlpTest, PassesOnWhatIsFinite) {
  double cost = 0.0;
  Eigen::VectorXd gradient(4);
  EXPECT_TRUE(guarded_.cost(z_, cost));
  EXPECT_EQ(cost, 16.0);
  EXPECT_TRUE(guarded_.cost_gradient(z_, gradient));
  EXPECT_EQ(gradient[3], 11.0);
  EXPECT_TRUE(guarded_.constraints(z_, g_));
  EXPECT_EQ(g_, Eigen::Vector2d(25.0, 52.0));
  EXPECT_TRUE(guarded_.jacobian(z_, jacobian_));
  EXPECT_TRUE(guarded_.hessian(z_, 1.0, multipliers_, hessian_));
  EXPECT_EQ(guarded_.failure(), "");
  EXPECT_GT(guarded_.times().evaluation(), 0.0);
}

TEST_F(GuardedNlpTest, NamesRowAndVariableOfWhatIsNotFinite) {
  nlp_.cost_error = NAN;
  double cost = 0.0;
  EXPECT_FALSE(guarded_.cost(z_, cost));
  EXPECT_THAT(guarded_.failure(), HasSubstr("cost is nan"));

  nlp_.nan_constraint = 1;
  EXPECT_FALSE(guarded_.constraints(z_, g_));
  EXPECT_THAT(guarded_.failure(), AllOf(HasSubstr("nan"), HasSubstr("constraint 1")));

  nlp_.nan_jacobian = 6;
  EXPECT_FALSE(guarded_.jacobian(z_, jacobian_));
  EXPECT_THAT(guarded_.failure(), AllOf(HasSubstr("inf"), HasSubstr("constraint 1, by variable 2")));

  nlp_.nan_hessian = 4;
  EXPECT_FALSE(guarded_.hessian(z_, 1.0, multipliers_, hessian_));
  EXPECT_THAT(guarded_.failure(), HasSubstr("variable 2, by variable 1"));

  EXPECT_FALSE(guarded_.finite_point(Eigen::Vector4d(1.0, 2.0, INFINITY, 3.0)));
  EXPECT_THAT(guarded_.failure(), HasSubstr("variable 2"));
  EXPECT_FALSE(guarded_.broken());
}

TEST_F(GuardedNlpTest, ANumericalErrorIsOneFailedEvaluation) {
  nlp_.throw_numerical = true;
  EXPECT_FALSE(guarded_.constraints(z_, g_));
  EXPECT_THAT(guarded_.failure(), HasSubstr("contact Jacobian of phase 1 is singular"));
  EXPECT_FALSE(guarded_.broken());
  nlp_.throw_numerical = false;
  EXPECT_TRUE(guarded_.constraints(z_, g_));
  guarded_.forget_failure();
  EXPECT_EQ(guarded_.failure(), "");
}

TEST_F(GuardedNlpTest, AnyOtherExceptionEndsAllEvaluations) {
  nlp_.throw_logic = true;
  EXPECT_FALSE(guarded_.constraints(z_, g_));
  EXPECT_TRUE(guarded_.broken());
  nlp_.throw_logic = false;
  EXPECT_FALSE(guarded_.constraints(z_, g_));
  guarded_.forget_failure();
  EXPECT_THAT(guarded_.failure(), HasSubstr("a mistake"));
}

TEST_F(GuardedNlpTest, EvenWhatIsNotAnExceptionStopsHere) {
  nlp_.throw_int = true;
  EXPECT_FALSE(guarded_.constraints(z_, g_));
  EXPECT_TRUE(guarded_.broken());
}

}  // namespace
}  // namespace prowl

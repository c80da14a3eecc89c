#include "tests/support/derivative_check.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

const Eigen::Vector4d kPoint(1.1, 4.3, 3.7, 1.4);
const Eigen::Vector2d kMultipliers(-0.7, 0.4);
constexpr double kCostFactor = 1.3;

test::DerivativeReport check(Nlp& nlp) { return test::check_derivatives(nlp, kPoint, kCostFactor, kMultipliers); }

/// Adds an error to one entry of one derivative.
struct Wrong : test::Hs071 {
  int gradient_entry = -1, jacobian_entry = -1, hessian_entry = -1;
  double error = 1e-4;

  void cost_gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> gradient) override {
    Hs071::cost_gradient(x, gradient);
    if (gradient_entry >= 0) gradient[gradient_entry] += error;
  }
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    Hs071::jacobian(x, values);
    if (jacobian_entry >= 0) values[jacobian_entry] += error;
  }
  void hessian(const Eigen::VectorXd& x, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    Hs071::hessian(x, cost_factor, multipliers, values);
    if (hessian_entry >= 0) values[hessian_entry] += error;
  }
};

/// x0 x1 with its constraint x0^2 + x1 <= 1, and patterns as the test likes them.
struct TwoVariables : test::TestNlp {
  TwoVariables() {
    z_lower.setConstant(2, -kInfinity);
    z_upper.setConstant(2, kInfinity);
    g_lower.setConstant(1, -kInfinity);
    g_upper.setConstant(1, 1.0);
    jacobian_entries = {{0, 0}, {0, 1}};
    hessian_entries = {{0, 1}, {0, 0}};
  }
  double cost(const Eigen::VectorXd& x) override { return x[0] * x[1]; }
  void cost_gradient(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> g) override { g << x[1], x[0]; }
  void constraints(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> g) override { g[0] = x[0] * x[0] + x[1]; }
  void jacobian(const Eigen::VectorXd& x, Eigen::Ref<Eigen::VectorXd> values) override {
    for (int i = 0; i < jacobian_entries.size(); ++i) values[i] = jacobian_entries.cols[i] == 0 ? 2.0 * x[0] : 1.0;
  }
  void hessian(const Eigen::VectorXd&, double cost_factor, const Eigen::VectorXd& multipliers,
               Eigen::Ref<Eigen::VectorXd> values) override {
    for (int i = 0; i < hessian_entries.size(); ++i) {
      values[i] = hessian_entries.rows[i] == hessian_entries.cols[i] ? 2.0 * multipliers[0] : cost_factor;
    }
  }
  test::DerivativeReport check() {
    return test::check_derivatives(*this, Eigen::Vector2d(0.3, -0.8), kCostFactor, Eigen::VectorXd::Constant(1, 0.6));
  }
};

TEST(DerivativeCheck, FindsNothingWhereNothingIsWrong) {
  test::Hs071 nlp;
  const test::DerivativeReport report = check(nlp);
  EXPECT_LT(report.worst(), 1e-8) << report.summary();
  EXPECT_THAT(report.pattern_faults, IsEmpty());
  EXPECT_FALSE(report.gradient.where.empty() || report.jacobian.where.empty() || report.hessian.where.empty())
      << "nothing was compared";
}

TEST(DerivativeCheck, FindsAWrongGradient) {
  for (int entry = 0; entry < 4; ++entry) {
    Wrong nlp;
    nlp.gradient_entry = entry;
    const test::DerivativeReport report = check(nlp);
    EXPECT_GT(report.gradient.relative, 1e-6);
    EXPECT_EQ(report.gradient.where, "variable " + std::to_string(entry));
    EXPECT_LT(report.jacobian.relative, 1e-8);
  }
}

TEST(DerivativeCheck, FindsAWrongJacobianEntryAndItsIndices) {
  for (int entry = 0; entry < 8; ++entry) {
    Wrong nlp;
    nlp.jacobian_entry = entry;
    const test::DerivativeReport report = check(nlp);
    EXPECT_GT(report.jacobian.relative, 1e-6);
    EXPECT_EQ(report.jacobian.row, entry / 4);
    EXPECT_EQ(report.jacobian.col, entry % 4);
    EXPECT_LT(report.gradient.relative, 1e-8);
  }
}

TEST(DerivativeCheck, FindsAWrongHessianEntryAndItsIndices) {
  Wrong nlp;
  for (int entry = 0; entry < nlp.hessian_entries.size(); ++entry) {
    nlp.hessian_entry = entry;
    const test::DerivativeReport report = check(nlp);
    EXPECT_GT(report.hessian.relative, 1e-6);
    EXPECT_EQ(report.hessian.row, nlp.hessian_entries.rows[entry]);
    EXPECT_EQ(report.hessian.col, nlp.hessian_entries.cols[entry]);
    EXPECT_LT(report.jacobian.relative, 1e-8);
  }
}

TEST(DerivativeCheck, FindsNanInADerivative) {
  Wrong nlp;
  nlp.jacobian_entry = 3;
  nlp.error = std::nan("");
  const test::DerivativeReport report = check(nlp);
  EXPECT_TRUE(std::isinf(report.jacobian.relative));
  EXPECT_EQ(report.jacobian.col, 3);
}

TEST(DerivativeCheck, AcceptsASparsePatternThatIsComplete) {
  TwoVariables nlp;
  const test::DerivativeReport report = nlp.check();
  EXPECT_LT(report.worst(), 1e-8) << report.summary();
  EXPECT_THAT(report.pattern_faults, IsEmpty());
}

TEST(DerivativeCheck, FindsWhatIsMissingInThePatterns) {
  TwoVariables nlp;
  nlp.jacobian_entries = {{0}, {0}};
  EXPECT_THAT(nlp.check().pattern_faults, Contains(HasSubstr("constraint 0 by variable 1")));

  nlp = {};
  nlp.hessian_entries = {{0}, {0}};
  EXPECT_THAT(nlp.check().pattern_faults, ElementsAre(HasSubstr("variable 1 by variable 0")));
}

TEST(DerivativeCheck, FindsIndicesThatNoMatrixHas) {
  TwoVariables nlp;
  nlp.jacobian_entries = {{0, 0, 0}, {0, 1, 2}};
  EXPECT_THAT(nlp.check().pattern_faults, ElementsAre("Jacobian (0, 2) is outside the matrix"));

  nlp = {};
  nlp.hessian_entries = {{0, 1, 0}, {0, 0, 1}};
  EXPECT_THAT(nlp.check().pattern_faults, ElementsAre("Hessian (0, 1) is above the diagonal"));

  nlp = {};
  nlp.jacobian_entries = {{0, 0, 0}, {0, 1, 1}};
  EXPECT_THAT(nlp.check().pattern_faults, ElementsAre("Jacobian (0, 1) is in the sparsity pattern twice"));
}

}  // namespace
}  // namespace prowl

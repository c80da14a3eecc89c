#include "prowl/nlp/elastic_nlp.hpp"

#include <gtest/gtest.h>

#include <optional>

#include "tests/nlp/test_problems.hpp"
#include "tests/support/derivative_check.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kInfinity = test::TestNlp::kInfinity;

/// Hs071 with a soft row of each kind and two soft variables, one of which has an upper bound only.
struct Soft {
  Soft() {
    inner.z_lower(2) = -kInfinity;
    elastic.emplace(
        inner,
        std::vector<SoftBound>{{true, 1, 2.0, 3.0}, {false, 2, 0.5, 4.0}, {true, 0, 10.0, 5.0}, {false, 0, 1.5, 6.0}},
        0.7);
  }
  test::Hs071 inner;
  std::optional<ElasticNlp> elastic;
};

TEST(ElasticNlp, HasASlackForEachSoftBoundThatThereIs) {
  const Soft soft;
  EXPECT_EQ(soft.elastic->num_variables(), 4 + 2 + 1 + 1 + 2) << "an equation, an upper bound, a lower bound, and both";
  EXPECT_EQ(soft.elastic->num_constraints(), 2 + 2);
  for (const int soft_variable : {0, 2}) {
    EXPECT_EQ(soft.elastic->variable_lower()(soft_variable), -kInfinity);
    EXPECT_EQ(soft.elastic->variable_upper()(soft_variable), kInfinity);
  }
  EXPECT_EQ(soft.elastic->variable_lower()(1), 1.0) << "what is not soft stays";
  EXPECT_TRUE((soft.elastic->variable_lower().tail(6).array() == 0.0).all());
}

TEST(ElasticNlp, HasExactDerivatives) {
  Soft soft;
  const VectorXd z = VectorXd::LinSpaced(10, 0.8, 2.9);
  const VectorXd multipliers = VectorXd::LinSpaced(4, -0.7, 0.9);
  const test::DerivativeReport report = test::check_derivatives(*soft.elastic, z, 1.3, multipliers);
  EXPECT_LT(report.worst(), 1e-8) << report.summary();
  EXPECT_TRUE(report.pattern_faults.empty()) << report.summary();
}

TEST(ElasticNlp, StartsWhereAllSoftBoundsHold) {
  Soft soft;
  const Eigen::Vector4d z(-3.0, 2.0, 7.0, 1.5);
  const VectorXd z_guess = soft.elastic->with_slacks(z);
  EXPECT_EQ(soft.elastic->inner(z_guess), z);
  VectorXd g(4);
  soft.elastic->constraints(z_guess, g);
  for (int row = 0; row < 4; ++row) {
    EXPECT_GE(g(row), soft.elastic->constraint_lower()(row) - 1e-12) << row;
    EXPECT_LE(g(row), soft.elastic->constraint_upper()(row) + 1e-12) << row;
  }
}

TEST(ElasticNlp, TellsWhatGivesWayWithItsSign) {
  Soft soft;
  const Eigen::Vector4d z(-3.0, 2.0, 7.0, 1.5);
  VectorXd g(2);
  soft.inner.constraints(z, g);
  const VectorXd violations = soft.elastic->violations(soft.elastic->with_slacks(z));
  constexpr double kRoom = 0.01;  // of the size, both ways where there are two bounds
  EXPECT_NEAR(violations(0), 40.0 - g(1), 1e-9) << "above: < 0";
  EXPECT_NEAR(violations(1), 5.0 - 7.0 - 0.5 * kRoom, 1e-9);
  EXPECT_NEAR(violations(2), 25.0 - g(0) + 10.0 * kRoom, 1e-9) << "below: > 0";
  EXPECT_NEAR(violations(3), 1.0 - -3.0, 1e-9);
}

TEST(ElasticNlp, NamesRowsAndSlacks) {
  const Soft soft;
  EXPECT_EQ(soft.elastic->describe_constraint(1), "constraint 1");
  EXPECT_EQ(soft.elastic->describe_constraint(2), "variable 2, soft bounds");
  EXPECT_EQ(soft.elastic->describe_variable(4), "constraint 1, violated below");
  EXPECT_EQ(soft.elastic->describe_variable(5), "constraint 1, violated above");
  EXPECT_EQ(soft.elastic->describe_variable(6), "variable 2, soft bounds, violated above");
}

}  // namespace
}  // namespace prowl

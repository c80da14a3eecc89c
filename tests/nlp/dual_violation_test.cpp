#include "prowl/nlp/dual_violation.hpp"

#include <gtest/gtest.h>

#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using Eigen::Vector2d;
using Eigen::Vector4d;

// Optimum and multipliers of Hock, Schittkowski 1981; x0 is at its lower bound, where the gradient may push it.
const Vector4d kOptimum(1.0, 4.74299964, 3.82114998, 1.37940829);
const Vector2d kMultipliers(-0.55229366, 0.16146857);

TEST(DualViolation, VanishesAtAnOptimumWithItsMultipliers) {
  test::Hs071 nlp;
  EXPECT_LT(dual_violation(nlp, kOptimum, kMultipliers), 1e-6);
}

TEST(DualViolation, IsTheGradientWhereNoBoundIsNear) {
  test::Hs071 nlp;
  const Vector4d z(2.0, 3.0, 2.5, 3.0);
  nlp.z_lower.setConstant(-1e3);
  nlp.z_upper.setConstant(1e3);
  Eigen::VectorXd gradient(4);
  nlp.cost_gradient(z, gradient);
  EXPECT_DOUBLE_EQ(dual_violation(nlp, z, Vector2d::Zero()), gradient.lpNorm<Eigen::Infinity>());
}

TEST(DualViolation, SeesWrongMultipliersAndAGradientThatLeavesTheBound) {
  test::Hs071 nlp;
  EXPECT_GT(dual_violation(nlp, kOptimum, -kMultipliers), 1.0);
  nlp.z_upper[0] = 1.0;  // now x0 is at its upper bound, too: fixed, whatever the gradient
  EXPECT_LT(dual_violation(nlp, kOptimum, kMultipliers), 1e-6);
  nlp.z_lower[0] = 0.0;  // and now at the upper one only, from which the gradient pulls it away
  EXPECT_GT(dual_violation(nlp, kOptimum, kMultipliers), 0.5);
}

}  // namespace
}  // namespace prowl

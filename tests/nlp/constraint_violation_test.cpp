#include "prowl/nlp/constraint_violation.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/nlp/test_problems.hpp"

namespace prowl {
namespace {

using Eigen::Vector2d;
using Eigen::Vector4d;

const Vector4d kInside(1.0, 2.0, 3.0, 5.0);

TEST(ConstraintViolation, IsZeroInsideAndOnTheBounds) {
  EXPECT_EQ(constraint_violation(test::Hs071(), kInside, Vector2d(25.0, 40.0)), 0.0);
  EXPECT_EQ(constraint_violation(test::Hs071(), kInside, Vector2d(1e9, 40.0)), 0.0);
}

TEST(ConstraintViolation, IsTheDistanceToTheBoundThatIsFurthestAway) {
  const test::Hs071 nlp;
  EXPECT_EQ(constraint_violation(nlp, kInside, Vector2d(24.5, 40.0)), 0.5);
  EXPECT_EQ(constraint_violation(nlp, kInside, Vector2d(24.5, 42.0)), 2.0);
  EXPECT_EQ(constraint_violation(nlp, Vector4d(1.0, 9.0, 3.0, 5.0), Vector2d(24.5, 42.0)), 4.0);
  EXPECT_EQ(constraint_violation(nlp, Vector4d(-6.0, 9.0, 3.0, 5.0), Vector2d(24.5, 42.0)), 7.0);
}

TEST(ConstraintViolation, OfNanIsInfinite) {
  EXPECT_TRUE(std::isinf(constraint_violation(test::Hs071(), kInside, Vector2d(NAN, 40.0))));
  EXPECT_TRUE(std::isinf(constraint_violation(test::Hs071(), Vector4d(NAN, 2.0, 3.0, 5.0), Vector2d(25.0, 40.0))));
}

}  // namespace
}  // namespace prowl

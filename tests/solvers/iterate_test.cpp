#include "prowl/nlp/iterate.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

constexpr double kTolerance = 1e-6;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

bool is_better(double violation_a, double cost_a, double violation_b, double cost_b) {
  return is_better(IterateFigures{.cost = cost_a, .violation = violation_a},
                   IterateFigures{.cost = cost_b, .violation = violation_b}, kTolerance);
}

TEST(Iterate, IsBetterWithLessViolationThenWithLessCost) {
  EXPECT_TRUE(is_better(0.1, 9.0, 0.2, 1.0));
  EXPECT_FALSE(is_better(0.2, 1.0, 0.1, 9.0));
  EXPECT_TRUE(is_better(0.1, 1.0, 0.1, 2.0));
  EXPECT_FALSE(is_better(0.1, 2.0, 0.1, 2.0));
  EXPECT_TRUE(is_better(9e-7, 1.0, 1e-9, 2.0)) << "both are within tolerance";
}

/// A solve whose model could not be evaluated must not be what is kept for good.
TEST(Iterate, IsBetterThanNan) {
  EXPECT_TRUE(is_better(0.1, 9.0, kNan, 1.0));
  EXPECT_FALSE(is_better(kNan, 1.0, 0.1, 9.0));
  EXPECT_TRUE(is_better(0.1, 9.0, 0.1, kNan));
  EXPECT_FALSE(is_better(0.1, kNan, 0.1, 9.0));
  EXPECT_FALSE(is_better(kNan, kNan, kNan, kNan));
}

}  // namespace
}  // namespace prowl

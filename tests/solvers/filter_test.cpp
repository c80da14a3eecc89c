#include "prowl/solvers/riccati/filter.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

TEST(Filter, TakesWhatNoPairIsBetterThan) {
  Filter filter;
  filter.reset(10.0);
  EXPECT_TRUE(filter.accepts(9.0, 1e9));
  filter.add(2.0, 5.0);
  filter.add(4.0, 3.0);
  EXPECT_TRUE(filter.accepts(1.9, 1e9)) << "less violation than all";
  EXPECT_TRUE(filter.accepts(9.0, 2.9)) << "a lower barrier function than all";
  EXPECT_TRUE(filter.accepts(3.0, 4.0)) << "between both";
  EXPECT_FALSE(filter.accepts(2.0, 5.0)) << "one of them itself";
  EXPECT_FALSE(filter.accepts(3.0, 5.0));
  EXPECT_FALSE(filter.accepts(4.1, 3.0));
}

TEST(Filter, TakesNoMoreThanTheLargestViolation) {
  Filter filter;
  filter.reset(10.0);
  EXPECT_TRUE(filter.accepts(10.0, 0.0));
  EXPECT_FALSE(filter.accepts(10.1, -1e9));
}

TEST(Filter, ForgetsItsPairsOnReset) {
  Filter filter;
  filter.reset(10.0);
  filter.add(1.0, 1.0);
  ASSERT_FALSE(filter.accepts(2.0, 2.0));
  filter.reset(5.0);
  EXPECT_TRUE(filter.accepts(2.0, 2.0));
  EXPECT_FALSE(filter.accepts(6.0, 2.0));
}

}  // namespace
}  // namespace prowl

#include "prowl/motion/margins.hpp"

#include <gtest/gtest.h>

namespace prowl {
namespace {

TEST(Margins, AreLinearBetweenTheirMoments) {
  Eigen::MatrixXd margins(2, 3);
  margins << 0.0, 2.0, 4.0,  //
      1.0, 1.0, 5.0;
  EXPECT_EQ(margin_at(margins, 0.0), Eigen::Vector2d(0.0, 1.0));
  EXPECT_EQ(margin_at(margins, 0.25), Eigen::Vector2d(1.0, 1.0));
  EXPECT_EQ(margin_at(margins, 0.75), Eigen::Vector2d(3.0, 3.0));
  EXPECT_EQ(margin_at(margins, 1.0), Eigen::Vector2d(4.0, 5.0));
  EXPECT_EQ(margin_at(margins, 1.0 + 1e-12), Eigen::Vector2d(4.0, 5.0)) << "rounding";
}

TEST(Margins, OfOneMomentHoldThroughout) { EXPECT_EQ(margin_at(Eigen::MatrixXd::Constant(1, 1, 3.0), 0.7)(0), 3.0); }

}  // namespace
}  // namespace prowl

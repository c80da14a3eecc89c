// A rectangle inside the flat part of a foot.
#include "prowl/starter/sole.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace prowl {
namespace {

Eigen::Matrix3Xd with_upper_part(const Eigen::Matrix3Xd& sole) {
  Eigen::Matrix3Xd foot(3, 2 * sole.cols());
  foot << sole, 3.0 * sole;  // wider above: none of it may count
  foot.rightCols(sole.cols()).row(2).setConstant(0.05);
  return foot;
}

Eigen::Matrix3Xd box_sole(double length, double width) {
  Eigen::Matrix3Xd points(3, 4);
  points << -length, length, length, -length, -width, -width, width, width, 0.0, 0.0, 0.0, 0.0;
  points *= 0.5;
  return points;
}

TEST(Sole, OfABoxIsTheBoxDrawnInByThreePercent) {
  const auto sole = find_sole(with_upper_part(box_sole(0.2, 0.1)));
  ASSERT_TRUE(sole);
  EXPECT_NEAR(sole->upper.x() - sole->lower.x(), 0.97 * 0.2, 1e-9);
  EXPECT_NEAR(sole->upper.y() - sole->lower.y(), 0.97 * 0.1, 1e-9);
  EXPECT_NEAR((sole->upper + sole->lower).norm(), 0.0, 1e-9);
}

TEST(Sole, MovesWithTheFoot) {
  const Eigen::Vector3d by(0.3, -0.2, 0.7);
  const auto sole = find_sole(with_upper_part(box_sole(0.2, 0.1)));
  const auto moved = find_sole(with_upper_part(box_sole(0.2, 0.1)).colwise() + by);
  ASSERT_TRUE(sole && moved);
  EXPECT_LT((moved->lower - sole->lower - by.head<2>()).norm(), 1e-9);
  EXPECT_LT((moved->upper - sole->upper - by.head<2>()).norm(), 1e-9);
}

TEST(Sole, OfAnEllipseIsInsideItAndNearlyTheLargest) {
  constexpr double kLength = 0.24, kWidth = 0.1;
  Eigen::Matrix3Xd points(3, 200);
  for (int i = 0; i < 200; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / 200;
    points.col(i) = Eigen::Vector3d(0.5 * kLength * std::cos(angle), 0.5 * kWidth * std::sin(angle), 0.0);
  }
  const auto sole = find_sole(points);
  ASSERT_TRUE(sole);
  for (const double x : {sole->lower.x(), sole->upper.x()}) {
    for (const double y : {sole->lower.y(), sole->upper.y()}) {
      EXPECT_LT(std::pow(2.0 * x / kLength, 2) + std::pow(2.0 * y / kWidth, 2), 1.0);
    }
  }
  // The largest rectangle in an ellipse has half the area of its box.
  EXPECT_GT((sole->upper - sole->lower).prod(), 0.9 * 0.97 * 0.97 * 0.5 * kLength * kWidth);
}

TEST(Sole, IsNoneOfAnEdgeOrAPoint) {
  EXPECT_FALSE(find_sole(with_upper_part(box_sole(0.2, 0.005))));
  EXPECT_FALSE(find_sole(Eigen::Matrix3Xd::Random(3, 2)));
  EXPECT_FALSE(find_sole(Eigen::Matrix3Xd(3, 0)));
}

}  // namespace
}  // namespace prowl

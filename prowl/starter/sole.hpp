#pragma once

#include <Eigen/Core>
#include <optional>

namespace prowl {

inline constexpr double kToe = 0.02;  ///< [m]; the toe is the longer end of a foot, and ahead if neither is

/// A rectangle along x and y [m].
struct Rectangle {
  Eigen::Vector2d lower, upper;
};

/// The largest rectangle along the axes with all corners inside the convex hull of the lowest points, those within a
/// few millimetres of the lowest one, drawn in by 3 %. `points`: of a foot, z up [m]. None if they are no
/// sole: less than 2 cm long or wide.
std::optional<Rectangle> find_sole(const Eigen::Matrix3Xd& points);

}  // namespace prowl

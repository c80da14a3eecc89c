#pragma once

#include <Eigen/Core>
#include <optional>

namespace prowl {

inline constexpr double kToe = 0.02;  ///< [m]; the toe is the end longer by this, else the front

/// An axis-aligned rectangle [m].
struct Rectangle {
  Eigen::Vector2d lower, upper;
};

/// Largest axis-aligned rectangle inside the convex hull of the points within a few millimetres of
/// the lowest one, shrunk by 3 %. `points`: 3 x n, of a foot, z up [m]. Nullopt if it is less than
/// 2 cm long or wide.
std::optional<Rectangle> find_sole(const Eigen::Matrix3Xd& points);

}  // namespace prowl

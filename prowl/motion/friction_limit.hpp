#pragma once

#include <Eigen/Core>
#include <optional>

#include "prowl/model/surface.hpp"
#include "prowl/motion/friction_cone.hpp"

namespace prowl {

enum class FrictionModel {
  cone,     ///< the second-order cone, smoothed at its tip (FrictionCone): one row
  pyramid,  ///< four planes inside it: linear in the force, and up to 29 % less friction
};

/// Friction limit on the force f of one point contact (world frame [N]), as rows that must be >= 0 [N].
///
/// The pyramid has its corners on the cone, along the axes (t1, t2) of the surface turned by 45 degrees:
///   mu / sqrt(2) (fn - least) - t1 . f,   mu / sqrt(2) (fn - least) + t1 . f,   the same for t2.
/// Two opposite ones add up to fn >= least.
class FrictionLimit {
 public:
  static constexpr int kMostRows = 4;
  using Rows = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, kMostRows, 1>;
  using Slopes = Eigen::Matrix<double, Eigen::Dynamic, 3, 0, kMostRows, 3>;

  /// `smoothing` of the cone's tip [N]; the pyramid has none, and its tip at the normal force `least` [N].
  FrictionLimit(FrictionModel model, const Surface& surface, double smoothing, double least = 0.0);

  int count() const { return cone_ ? 1 : kMostRows; }
  Rows rows(const Eigen::Vector3d& force) const;
  Slopes slopes(const Eigen::Vector3d& force) const;  ///< derivative of the rows in the force
  /// Second derivative of multipliers . rows in the force.
  Eigen::Matrix3d curvature(const Eigen::Vector3d& force, const Eigen::Ref<const Eigen::VectorXd>& multipliers) const;

 private:
  std::optional<FrictionCone> cone_;
  Eigen::Matrix<double, kMostRows, 3> planes_;
  double offset_ = 0.0;  ///< of the planes from the origin [N]
};

}  // namespace prowl

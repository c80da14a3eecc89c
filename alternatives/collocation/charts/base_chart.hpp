#pragma once

#include <Eigen/Core>
#include <memory>

namespace prowl {

/// Three coordinates e of the base rotation R, with the angular velocity ω in the base frame:
///
///   ω = E(e) ė
///
/// One chart serves all nodes, so coordinates of neighbouring nodes can be subtracted.
class BaseChart {
 public:
  virtual ~BaseChart() = default;

  virtual Eigen::Matrix3d rotation(const Eigen::Vector3d& e) const = 0;  ///< R
  /// Coordinates of R closest to `near`. Throws InputError if there are none.
  virtual Eigen::Vector3d coordinates(const Eigen::Matrix3d& R, const Eigen::Vector3d& near) const = 0;
  virtual Eigen::Matrix3d rate(const Eigen::Vector3d& e) const = 0;  ///< E
  /// The symmetric B with uᵀ B u = λᵀ (d/ds E(e + s u) at s = 0) u, the curvature of the chart:
  ///   log(R(e)ᵀ R(e + u)) · λ = λᵀ E u + 1/2 uᵀ B u + O(|u|³).
  virtual Eigen::Matrix3d bend(const Eigen::Vector3d& e, const Eigen::Vector3d& lambda) const = 0;

  virtual Eigen::Matrix3d inverse_rate(const Eigen::Vector3d& e) const = 0;  ///< E⁻¹
  /// Derivative of E⁻¹ ω in e, at fixed ω.
  virtual Eigen::Matrix3d inverse_rate_slope(const Eigen::Vector3d& e, const Eigen::Vector3d& omega) const = 0;
  /// Second derivative of λ · E⁻¹ ω in e, at fixed ω.
  virtual Eigen::Matrix3d inverse_rate_curvature(const Eigen::Vector3d& e, const Eigen::Vector3d& omega,
                                                 const Eigen::Vector3d& lambda) const = 0;
};

/// R = R_origin exp(e), e the rotation vector [rad]: E = Jr(e). Limited to 4.4 rad from the origin,
/// as derivatives lose digits beyond.
std::unique_ptr<BaseChart> exponential_chart(const Eigen::Matrix3d& origin);
/// R = Rx(e0) Ry(e1) Rz(e2) [rad], as in Pardo et al. 2016. E is singular at e1 = ± pi/2, where
/// coordinates jump: |e1| <= pi/2.
std::unique_ptr<BaseChart> euler_chart();

}  // namespace prowl

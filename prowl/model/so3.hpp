#pragma once

#include <Eigen/Core>

/// Rotations and their rotation vectors θ = angle · axis [rad], and the derivatives of one by the other.
///
///   exp(θ + dθ) = exp(θ) exp(Jr(θ) dθ) + O(|dθ|²)
///   Jr(θ) = I - α [θ]ₓ + β [θ]ₓ²,   α = (1 - cos t)/t²,  β = (t - sin t)/t³,  t = |θ|
///
/// Solà, Deray, Atchuthan, "A micro Lie theory for state estimation in robotics", 2018, eq. (143) and (144).
/// Everything is exact to rounding at every θ, also at and near θ = 0.
namespace prowl::so3 {

Eigen::Matrix3d skew(const Eigen::Vector3d& w);  ///< skew(w) u = w x u
Eigen::Matrix3d exp(const Eigen::Vector3d& theta);
Eigen::Vector3d log(const Eigen::Matrix3d& R);  ///< |log R| <= pi
/// By the smallest angle, takes the direction of `from` to that of `to`.
Eigen::Matrix3d shortest_rotation(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

Eigen::Matrix3d right_jacobian(const Eigen::Vector3d& theta);
/// Jr(θ)⁻¹: log(exp(θ) exp(w)) = θ + Jr(θ)⁻¹ w + O(|w|²). Needs |θ| < 2 pi.
Eigen::Matrix3d right_jacobian_inverse(const Eigen::Vector3d& theta);

/// The symmetric B(θ, λ) with uᵀ B u = λᵀ (d/ds Jr(θ + s u) at s = 0) u for every u.
/// With it, along φ(s) = log(exp(θ) exp(s w)):  λᵀ φ''(0) = -wᵀ Jr⁻ᵀ B(θ, Jr⁻ᵀ λ) Jr⁻¹ w.
Eigen::Matrix3d right_jacobian_derivative(const Eigen::Vector3d& theta, const Eigen::Vector3d& lambda);

}  // namespace prowl::so3

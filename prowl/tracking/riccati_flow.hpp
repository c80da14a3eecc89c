#pragma once

#include <Eigen/Core>
#include <optional>

namespace prowl {

/// Flow over a time h of the optimal control of  x' = A x + B u,  cost ∫ x'Q x + u'R u dt,  with G
/// = B R⁻¹ B':
///
///   x(h) = transition x(0) − control λ(h),    λ(0) = cost x(0) + transition' λ(h),    λ = S x
///
/// It solves the differential Riccati equation −S' = A'S + S A − S G S + Q backwards over h,
/// exactly for constant coefficients and any step. `cost` and `control` are symmetric positive
/// semidefinite and no difference is formed, so S stays symmetric positive semidefinite.
/// docs/tracking.md#riccati-equation.
struct RiccatiFlow {
  Eigen::MatrixXd transition, control, cost;  ///< n x n

  /// S(0) from S(h) = S.
  Eigen::MatrixXd back(const Eigen::MatrixXd& S) const;
  /// x(0) -> x(h) under the optimal control with S(h) = S.
  Eigen::MatrixXd closed_loop(const Eigen::MatrixXd& S) const;
};

/// From the exponential of the Hamiltonian matrix (Kenney and Leipnik, Numerical integration of the
/// differential matrix Riccati equation, IEEE TAC 1985: the modified Davison-Maki method). G and Q:
/// symmetric, positive semidefinite; h [s].
RiccatiFlow riccati_flow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G, const Eigen::MatrixXd& Q, double h);

/// Flow of `first`, then `second`.
RiccatiFlow compose(const RiccatiFlow& first, const RiccatiFlow& second);

/// Stabilising fixed point S of back(), by doubling the time until convergence (Anderson,
/// Second-order convergent algorithms for the steady-state Riccati equation, 1978). Nullopt if none
/// exists: an uncontrollable direction does not decay.
std::optional<Eigen::MatrixXd> stationary_cost(RiccatiFlow flow);

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <optional>

namespace prowl {

/// What optimal control of  x' = A x + B u,  cost ∫ x'Q x + u'R u dt,  does over a time h, with G = B R⁻¹ B':
///
///   x(h) = transition x(0) − control λ(h),    λ(0) = cost x(0) + transition' λ(h),    λ = S x
///
/// With it the differential Riccati equation −S' = A'S + S A − S G S + Q is solved backwards over h, exactly for
/// constant coefficients, whatever the step: cost and control are symmetric and not negative, no difference is formed,
/// so that S stays symmetric and not negative. docs/tracking.md#riccati-equation.
struct RiccatiFlow {
  Eigen::MatrixXd transition, control, cost;  ///< n x n

  /// S(0) from S(h) = S.
  Eigen::MatrixXd back(const Eigen::MatrixXd& S) const;
  /// x(0) -> x(h) under the optimal control with S(h) = S.
  Eigen::MatrixXd closed_loop(const Eigen::MatrixXd& S) const;
};

/// From the exponential of the Hamiltonian matrix (Kenney and Leipnik, Numerical integration of the differential matrix
/// Riccati equation, IEEE TAC 1985: the modified Davison-Maki method). G and Q symmetric, not negative.
RiccatiFlow riccati_flow(const Eigen::MatrixXd& A, const Eigen::MatrixXd& G, const Eigen::MatrixXd& Q, double h);

/// One after the other.
RiccatiFlow compose(const RiccatiFlow& first, const RiccatiFlow& second);

/// S that back() leaves as it is, the one that stabilises: by doubling the time until it no longer matters (Anderson,
/// Second-order convergent algorithms for the steady-state Riccati equation, 1978). None if there is no such S: a
/// direction that no control moves and that does not die away by itself.
std::optional<Eigen::MatrixXd> stationary_cost(RiccatiFlow flow);

}  // namespace prowl

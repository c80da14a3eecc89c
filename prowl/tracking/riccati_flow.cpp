#include "prowl/tracking/riccati_flow.hpp"

#include <Eigen/LU>
#include <cmath>

#include "prowl/linear_algebra/factorisations.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;

MatrixXd symmetric(const MatrixXd& M) { return 0.5 * (M + M.transpose()); }

/// (I + G S)⁻¹ X. Regular for every symmetric G, S >= 0: the eigenvalues of G S are not negative.
MatrixXd solve_coupled(const MatrixXd& G, const MatrixXd& S, const MatrixXd& X) {
  MatrixXd coupled = G * S;
  coupled.diagonal().array() += 1.0;
  return coupled.partialPivLu().solve(X);
}

}  // namespace

MatrixXd RiccatiFlow::closed_loop(const MatrixXd& S) const { return solve_coupled(control, S, transition); }

MatrixXd RiccatiFlow::back(const MatrixXd& S) const {
  return symmetric(cost + transition.transpose() * (S * closed_loop(S)));
}

RiccatiFlow riccati_flow(const MatrixXd& A, const MatrixXd& G, const MatrixXd& Q, double h) {
  const Eigen::Index n = A.rows();
  // Scales λ so that both off-diagonal blocks have the same norm: fewer squarings, smaller rounding
  // errors.
  const double g = G.norm(), q = Q.norm();
  const double unit = g > 0.0 && q > 0.0 ? std::sqrt(q / g) : 1.0;
  MatrixXd hamiltonian(2 * n, 2 * n);
  hamiltonian << A, -unit * G, -Q / unit, -A.transpose();
  const MatrixXd theta = exponential(h * hamiltonian);

  // (x, λ)(h) = theta (x, λ)(0), solved for x(h) and λ(0).
  const auto corner = theta.bottomRightCorner(n, n).partialPivLu();
  RiccatiFlow flow;
  flow.transition = corner.inverse().transpose();
  flow.cost = symmetric(-unit * corner.solve(theta.bottomLeftCorner(n, n)));
  flow.control = symmetric(-theta.topRightCorner(n, n) * flow.transition.transpose()) / unit;
  return flow;
}

RiccatiFlow compose(const RiccatiFlow& first, const RiccatiFlow& second) {
  const Eigen::Index n = first.cost.rows();
  MatrixXd both(n, 2 * n);
  both << first.transition, first.control;
  const MatrixXd coupled = solve_coupled(first.control, second.cost, both);
  const auto transition = coupled.leftCols(n), control = coupled.rightCols(n);
  return {second.transition * transition,
          symmetric(second.control + second.transition * (control * second.transition.transpose())),
          symmetric(first.cost + first.transition.transpose() * (second.cost * transition))};
}

std::optional<MatrixXd> stationary_cost(RiccatiFlow flow) {
  constexpr int kMostDoublings = 40;
  constexpr double kSettled = 1e-13;
  for (int i = 0; i < kMostDoublings; ++i) {
    const RiccatiFlow twice = compose(flow, flow);
    if (!twice.cost.allFinite()) return std::nullopt;
    const double change = (twice.cost - flow.cost).norm();
    flow = twice;
    if (change <= kSettled * flow.cost.norm() && flow.transition.norm() < 1e-3) return flow.cost;
  }
  return std::nullopt;
}

}  // namespace prowl

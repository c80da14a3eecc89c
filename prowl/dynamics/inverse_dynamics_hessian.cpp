#include "prowl/dynamics/inverse_dynamics_hessian.hpp"

#include "prowl/dynamics/spatial_cross.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

}  // namespace

SecondDerivatives::SecondDerivatives(int nv) : qq(nv, nv), qv(nv, nv), vv(nv, nv), qa(nv, nv) { set_zero(); }

void SecondDerivatives::set_zero() {
  qq.setZero();
  qv.setZero();
  vv.setZero();
  qa.setZero();
}

SpatialVector WorldInertia::operator*(const SpatialVector& motion) const {
  const Vector3d linear = motion.head<3>(), angular = motion.tail<3>();
  return spatial(mass * linear + angular.cross(moment), moment.cross(linear) + rotational * angular);
}

SpatialVector InverseDynamicsHessian::Adjoint::D(const SpatialVector& X) const {
  const Vector3d linear = X.head<3>(), angular = X.tail<3>(), momentum = H.head<3>();
  return spatial(Vector3d::Zero(), 2.0 * linear.cross(momentum) + D_angular * angular);
}

InverseDynamicsHessian::InverseDynamicsHessian(std::vector<int> parents)
    : parents_(std::move(parents)),
      adjoints_(parents_.size()),
      N_(SpatialColumns::Zero(6, kBaseDofs - 1 + static_cast<Index>(parents_.size()))) {}

void InverseDynamicsHessian::add(const TreeMotion& tree, const Eigen::VectorXd& lambda, SecondDerivatives& result) {
  propagate(tree, lambda);
  add_base(tree, result);
  for (std::size_t body = 1; body < parents_.size(); ++body) add_joint(tree, body, result);
}

// Outwards: m and the terms of each body. Inwards: their sums over the bodies behind a joint.
void InverseDynamicsHessian::propagate(const TreeMotion& tree, const Eigen::VectorXd& lambda) {
  for (std::size_t i = 0; i < parents_.size(); ++i) {
    Adjoint& own = adjoints_[i];
    if (i == 0) {
      own.m.noalias() = tree.S.leftCols<kBaseDofs>() * lambda.head<kBaseDofs>();
    } else {
      const Index dof = kBaseDofs - 1 + static_cast<Index>(i);
      const SpatialVector& before = adjoints_[parents_[i]].m;
      own.m = before + tree.S.col(dof) * lambda(dof);
      N_.col(dof) = cross(before, tree.S.col(dof));
    }
    const TreeMotion::Body& body = tree.bodies[i];
    own.H = body.inertia * own.m;
    own.P = cross_force(body.velocity, own.H) - body.inertia * cross(body.velocity, own.m) -
            cross_force(own.m, body.inertia * body.velocity);
    // -D_angular is the change of the rotational inertia as the body moves with m, plus the skew matrix of a moment.
    const Matrix3d half = so3::skew(own.m.tail<3>()) * body.inertia.rotational -
                          so3::skew(own.m.head<3>()) * so3::skew(body.inertia.moment);
    own.D_angular = -(half + half.transpose()) - so3::skew(own.H.tail<3>());
  }
  for (std::size_t i = parents_.size() - 1; i > 0; --i) {
    const Adjoint& own = adjoints_[i];
    Adjoint& before = adjoints_[parents_[i]];
    before.H += own.H;
    before.P += own.P;
    before.D_angular += own.D_angular;
  }
}

// The world is before the base: N = V = 0, and A contains gravity only. Rotations of the base do not commute; the
// Hessian along q ⊕ d is the mean of both orders.
void InverseDynamicsHessian::add_base(const TreeMotion& tree, SecondDerivatives& result) const {
  const Adjoint& all = adjoints_.front();
  Eigen::Matrix<double, 6, kBaseDofs> alpha, sigma;
  for (Index k = 0; k < kBaseDofs; ++k) {
    const SpatialVector S = tree.S.col(k);
    alpha.col(k) = cross_force(S, all.H);
    // D_j without S_j x S_k . H: the base's joint does not turn itself.
    sigma.col(k) = all.D(S) - alpha.col(k);
  }
  const Matrix3d turned = tree.A.middleCols<3>(kFirstRotation).transpose() * alpha.rightCols<3>();
  result.qq.block<3, 3>(kFirstRotation, kFirstRotation) += 0.5 * (turned + turned.transpose());
  result.vv.topLeftCorner<kBaseDofs, kBaseDofs>().noalias() +=
      tree.S.leftCols<kBaseDofs>().transpose().lazyProduct(sigma);
}

// Joint k with all joints j before it. Every second derivative is linear in vectors of j, with factors of k.
void InverseDynamicsHessian::add_joint(const TreeMotion& tree, std::size_t body, SecondDerivatives& result) const {
  const Adjoint& behind = adjoints_[body];
  const TreeMotion::Body& composite = tree.bodies[body];
  const Index k = kBaseDofs - 1 + static_cast<Index>(body);
  const SpatialVector S = tree.S.col(k), V = tree.V.col(k), N = N_.col(k);
  const SpatialVector alpha = composite.composite_inertia * N + cross_force(S, behind.H);
  SpatialVector nu = behind.D(V) + cross_force(S, behind.P);
  nu.tail<3>() += composite.composite_variation.transpose() * N;
  const Vector3d sigma = behind.D(S).tail<3>();

  for (std::size_t i = body; i > 0; i = static_cast<std::size_t>(parents_[i])) {
    const Index j = kBaseDofs - 1 + static_cast<Index>(i);
    const auto N_j = N_.col(j), V_j = tree.V.col(j);
    const double qq = N_j.dot(tree.I_A_B_V_S_F.col(k)) + tree.A.col(j).dot(alpha) + V_j.dot(nu);
    const double vv = tree.S.col(j).tail<3>().dot(sigma);
    result.qq(j, k) += qq;
    result.vv(j, k) += vv;
    result.qv(j, k) += N_j.dot(tree.I_W_B_S.col(k)) + V_j.tail<3>().dot(sigma);
    result.qa(j, k) += N_j.dot(tree.I_S.col(k));
    if (j == k) continue;
    result.qq(k, j) += qq;
    result.vv(k, j) += vv;
    result.qv(k, j) += tree.W.col(j).dot(alpha) + tree.S.col(j).dot(nu);
    result.qa(k, j) += tree.S.col(j).dot(alpha);
  }

  const auto S_base = tree.S.leftCols<kBaseDofs>().transpose(), W_base = tree.W.leftCols<kBaseDofs>().transpose();
  const Vector3d qq = tree.A.middleCols<3>(kFirstRotation).topRows<3>().transpose() * alpha.head<3>();
  const SpatialVector vv = tree.S.leftCols<kBaseDofs>().bottomRows<3>().transpose() * sigma;
  result.qq.col(k).segment<3>(kFirstRotation) += qq;
  result.qq.row(k).segment<3>(kFirstRotation) += qq;
  result.vv.col(k).head<kBaseDofs>() += vv;
  result.vv.row(k).head<kBaseDofs>() += vv;
  result.qv.row(k).head<kBaseDofs>() += (W_base * alpha + S_base * nu).transpose();
  result.qa.row(k).head<kBaseDofs>() += (S_base * alpha).transpose();
}

}  // namespace prowl

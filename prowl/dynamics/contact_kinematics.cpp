#include "prowl/dynamics/contact_kinematics.hpp"

#include <Eigen/Geometry>

namespace prowl {

namespace {

using Eigen::Vector3d;
constexpr std::size_t kBaseDofs = 6;
constexpr std::size_t kFirstRotation = 3;  ///< places of the base (dofs 0-2 of q's tangent) move the world, not the robot

}  // namespace

void ContactKinematics::set_configuration(const RigidBodyTerms& terms) {
  const auto& columns = terms.motion_columns();
  chains_.resize(contacts_.size());
  positions_.resize(rows());
  acceleration_.resize(rows());
  jacobian_.setZero(rows(), terms.nv());
  positions_dq_.setZero(rows(), terms.nv());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const auto row = static_cast<Eigen::Index>(3 * c);
    const Vector3d p = terms.contact_position(contacts_[c]);
    const std::vector<int>& dofs = terms.contact_chain(contacts_[c]);
    positions_.segment<3>(row) = p;
    chains_[c].resize(dofs.size());
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      Link& link = chains_[c][i];
      link.dof = dofs[i];
      link.in_base = i < kBaseDofs;
      link.w = columns.col(dofs[i]).tail<3>();
      link.d = columns.col(dofs[i]).head<3>() + link.w.cross(p);
      jacobian_.block<3, 1>(row, dofs[i]) = link.d;
      positions_dq_.block<3, 1>(row, dofs[i]) = link.d;
    }
    positions_dq_.block<3, 3>(row, 0).setIdentity();
  }
}

void ContactKinematics::set_motion(const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    propagate_motion(chains_[c], v, a, acceleration_.segment(static_cast<Eigen::Index>(3 * c), 3));
  }
}

void ContactKinematics::propagate_motion(Chain& chain, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                                         Eigen::Ref<Eigen::VectorXd> acceleration) {
  // Outwards: how the bodies turn. The six degrees of freedom of the base act together, before all joints.
  Vector3d base_omega = Vector3d::Zero(), base_alpha = Vector3d::Zero();
  Vector3d base_velocity = Vector3d::Zero(), base_acceleration = Vector3d::Zero();  // of p, fixed to the base
  for (std::size_t i = 0; i < kBaseDofs; ++i) {
    const Link& link = chain[i];
    base_omega += link.w * v(link.dof);
    base_alpha += link.w * a(link.dof);
    base_velocity += link.d * v(link.dof);
    base_acceleration += link.d * a(link.dof);
  }
  base_acceleration += base_omega.cross(base_velocity);

  Vector3d omega = base_omega, alpha = base_alpha;
  for (std::size_t i = kBaseDofs; i < chain.size(); ++i) {
    Link& link = chain[i];
    link.omega = omega;
    link.alpha = alpha;
    const Vector3d joint_omega = link.w * v(link.dof);
    alpha += link.w * a(link.dof) + omega.cross(joint_omega);
    omega += joint_omega;
    link.omega_after = omega;
  }

  // Inwards: how p moves relative to the body before each joint.
  Vector3d v_rel = Vector3d::Zero(), a_rel = Vector3d::Zero();
  for (std::size_t i = chain.size(); i-- > kBaseDofs;) {
    Link& link = chain[i];
    const Vector3d joint_omega = link.w * v(link.dof);
    const Vector3d joint_velocity = link.d * v(link.dof);
    a_rel += link.d * a(link.dof) + joint_omega.cross(joint_velocity + 2.0 * v_rel);
    v_rel += joint_velocity;
    link.v_rel = v_rel;
    link.a_rel = a_rel;
    link.dg_dv = 2.0 * (link.omega.cross(link.d) + link.w.cross(v_rel));
    link.dg_dq = link.alpha.cross(link.d) + link.omega.cross(link.omega.cross(link.d) + 2.0 * link.w.cross(v_rel)) +
                 link.w.cross(a_rel);
  }
  const Vector3d leg_velocity = v_rel;  // relative to the base
  a_rel += base_acceleration + 2.0 * base_omega.cross(leg_velocity);
  v_rel += base_velocity;
  for (std::size_t i = 0; i < kBaseDofs; ++i) {
    Link& link = chain[i];
    link.omega.setZero();  // the body before the base is the world
    link.alpha.setZero();
    link.omega_after = base_omega;
    link.v_rel = v_rel;
    link.a_rel = a_rel;
    link.dg_dv = base_omega.cross(link.d) + link.w.cross(base_velocity + 2.0 * leg_velocity);
    link.dg_dq = link.w.cross(a_rel);
  }
  acceleration = a_rel;
}

void ContactKinematics::acceleration_dq(Eigen::MatrixXd& dg_dq) const {
  dg_dq.setZero(rows(), jacobian_.cols());
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    for (std::size_t i = kFirstRotation; i < chains_[c].size(); ++i) {
      const Link& link = chains_[c][i];
      dg_dq.block<3, 1>(static_cast<Eigen::Index>(3 * c), link.dof) = link.dg_dq;
    }
  }
}

void ContactKinematics::acceleration_dv(Eigen::MatrixXd& dg_dv) const {
  dg_dv.setZero(rows(), jacobian_.cols());
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    for (const Link& link : chains_[c]) {
      dg_dv.block<3, 1>(static_cast<Eigen::Index>(3 * c), link.dof) = link.dg_dv;
    }
  }
}

/// ∂²g/∂q_k ∂q_l, joint k (`first`) at or before joint l (`second`): the derivative of dg/dq_l when all that is behind
/// joint k turns with it, while the body before k keeps its motion.
Eigen::Vector3d ContactKinematics::second_dq(const Link& first, const Link& second) {
  const Vector3d& w = first.w;
  const Vector3d omega_rel = second.omega - first.omega;
  const Vector3d alpha_rel = second.alpha - first.alpha - first.omega.cross(omega_rel);
  const Vector3d omega_change = w.cross(omega_rel);
  const Vector3d alpha_change = w.cross(alpha_rel) + first.omega.cross(omega_change);
  const Vector3d d_change = w.cross(second.d);
  const Vector3d turn = second.w.cross(second.v_rel);
  return alpha_change.cross(second.d) + second.alpha.cross(d_change) +
         omega_change.cross(second.omega.cross(second.d) + 2.0 * turn) +
         second.omega.cross(omega_change.cross(second.d) + second.omega.cross(d_change) + 2.0 * w.cross(turn)) +
         w.cross(second.w.cross(second.a_rel));
}

/// ∂²g/∂q_l ∂v_j.
Eigen::Vector3d ContactKinematics::second_dqdv(const Chain& chain, std::size_t l, std::size_t j) {
  const Link& lq = chain[l];
  const Link& lv = chain[j];
  if (before_or_same(chain, l, j)) {  // v_j moves p relative to the body before joint l
    Vector3d a_rel_change = lv.dg_dv;
    if (!lv.in_base) a_rel_change -= 2.0 * lq.omega.cross(lv.d);
    return 2.0 * lq.omega.cross(lq.w.cross(lv.d)) + lq.w.cross(a_rel_change);
  }
  const Vector3d alpha_change = lv.omega.cross(lv.w) + lv.w.cross(lq.omega - lv.omega_after);
  return alpha_change.cross(lq.d) + lv.w.cross(lq.omega.cross(lq.d) + 2.0 * lq.w.cross(lq.v_rel)) +
         lq.omega.cross(lv.w.cross(lq.d));
}

void ContactKinematics::add_acceleration_hessian(const Eigen::VectorXd& lambda, SecondDerivatives& result) const {
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = lambda.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t l = kFirstRotation; l < chain.size(); ++l) {
      for (std::size_t k = kFirstRotation; k <= l; ++k) {
        double value = force.dot(second_dq(chain[k], chain[l]));
        if (k == l) {
          result.qq(chain[k].dof, chain[k].dof) += value;
          continue;
        }
        // Rotations of the base do not commute; the Hessian along q (+) d is their mean.
        if (chain[l].in_base) value = 0.5 * (value + force.dot(second_dq(chain[l], chain[k])));
        result.qq(chain[k].dof, chain[l].dof) += value;
        result.qq(chain[l].dof, chain[k].dof) += value;
      }
    }
    for (std::size_t j = 0; j < chain.size(); ++j) {
      for (std::size_t i = 0; i < chain.size(); ++i) {
        // ∂d_j/∂(velocity direction i), which for i >= 3 is also the derivative in q_i.
        const Vector3d change = before_or_same(chain, i, j) ? chain[i].w.cross(chain[j].d)
                                                            : chain[j].w.cross(chain[i].d);
        const double value = force.dot(change);
        result.vv(chain[i].dof, chain[j].dof) += value;
        result.vv(chain[j].dof, chain[i].dof) += value;
        if (i < kFirstRotation) continue;
        result.qa(chain[i].dof, chain[j].dof) += value;
        result.qv(chain[i].dof, chain[j].dof) += force.dot(second_dqdv(chain, i, j));
      }
    }
  }
}

void ContactKinematics::add_force_derivative(const Eigen::VectorXd& f, Eigen::MatrixXd& out) const {
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = f.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t i = kFirstRotation; i < chain.size(); ++i) {
      for (std::size_t j = 0; j < chain.size(); ++j) {
        const Vector3d change = before_or_same(chain, i, j) ? chain[i].w.cross(chain[j].d)
                                                            : chain[j].w.cross(chain[i].d);
        out(chain[j].dof, chain[i].dof) += force.dot(change);
      }
    }
  }
}

void ContactKinematics::add_position_hessian(const Eigen::VectorXd& lambda, double scale, Eigen::MatrixXd& out) const {
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = scale * lambda.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t l = kFirstRotation; l < chain.size(); ++l) {
      for (std::size_t k = kFirstRotation; k <= l; ++k) {
        double value = force.dot(chain[k].w.cross(chain[l].d));
        if (k == l) {
          out(chain[k].dof, chain[k].dof) += value;
          continue;
        }
        if (chain[l].in_base) value = 0.5 * (value + force.dot(chain[l].w.cross(chain[k].d)));
        out(chain[k].dof, chain[l].dof) += value;
        out(chain[l].dof, chain[k].dof) += value;
      }
    }
  }
}

}  // namespace prowl

#include "prowl/dynamics/point_kinematics.hpp"

namespace prowl {

namespace {

using Eigen::Vector3d;

}  // namespace

void PointKinematics::set_configuration(const RigidBodyTerms& terms) {
  const auto& columns = terms.motion_columns();
  chains_.resize(points_.size());
  positions_.resize(rows());
  acceleration_.resize(rows());
  if (jacobian_.rows() != rows() ||
      jacobian_.cols() != terms.nv()) {  // otherwise entries not set below are zero already
    jacobian_.setZero(rows(), terms.nv());
    positions_dq_.setZero(rows(), terms.nv());
  }
  for (std::size_t c = 0; c < points_.size(); ++c) {
    const auto row = static_cast<Eigen::Index>(3 * c);
    const BodyPoint& point = points_[c];
    const bool is_point = point.kind == BodyPoint::Kind::point;
    Vector3d p = terms.body_rotation(point.body) * point.in_body;
    if (is_point) p = terms.body_position(point.body) + p;
    const std::vector<int>& dofs = terms.body_chain(point.body);
    positions_.segment<3>(row) = p;
    chains_[c].resize(dofs.size());
    for (std::size_t i = 0; i < dofs.size(); ++i) {
      Link& link = chains_[c][i];
      link.dof = dofs[i];
      link.w = columns.col(dofs[i]).tail<3>();
      link.d = link.w.cross(p);
      if (is_point) link.d = columns.col(dofs[i]).head<3>() + link.d;
      jacobian_.block<3, 1>(row, dofs[i]) = link.d;
      positions_dq_.block<3, 1>(row, dofs[i]) = link.d;
    }
    if (is_point) positions_dq_.block<3, 3>(row, 0).setIdentity();
  }
}

void PointKinematics::set_motion(const Eigen::VectorXd& v, const Eigen::VectorXd& a) {
  for (std::size_t c = 0; c < points_.size(); ++c) {
    propagate_motion(chains_[c], v, a, acceleration_.segment(static_cast<Eigen::Index>(3 * c), 3));
  }
}

void PointKinematics::propagate_motion(Chain& chain, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                                       Eigen::Ref<Eigen::VectorXd> acceleration) {
  // Outwards: rotation of the bodies. The six degrees of freedom of the base act together, before all joints.
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

  // Inwards: motion of p relative to the body before each joint.
  Vector3d v_rel = Vector3d::Zero(), a_rel = Vector3d::Zero();
  for (std::size_t i = chain.size(); i-- > kBaseDofs;) {
    Link& link = chain[i];
    const Vector3d joint_omega = link.w * v(link.dof);
    const Vector3d joint_velocity = link.d * v(link.dof);
    a_rel += link.d * a(link.dof) + joint_omega.cross(joint_velocity + 2.0 * v_rel);
    v_rel += joint_velocity;
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
    link.dg_dv = base_omega.cross(link.d) + link.w.cross(base_velocity + 2.0 * leg_velocity);
    link.dg_dq = link.w.cross(a_rel);
  }
  acceleration = a_rel;
}

void PointKinematics::acceleration_dq(Eigen::MatrixXd& dg_dq) const {
  dg_dq.setZero(rows(), jacobian_.cols());
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    for (std::size_t i = kFirstRotation; i < chains_[c].size(); ++i) {
      const Link& link = chains_[c][i];
      dg_dq.block<3, 1>(static_cast<Eigen::Index>(3 * c), link.dof) = link.dg_dq;
    }
  }
}

void PointKinematics::acceleration_dv(Eigen::MatrixXd& dg_dv) const {
  dg_dv.setZero(rows(), jacobian_.cols());
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    for (const Link& link : chains_[c]) {
      dg_dv.block<3, 1>(static_cast<Eigen::Index>(3 * c), link.dof) = link.dg_dv;
    }
  }
}

// With k at or before l in the chain, V and A of Link (docs/theory.md, after (9)):
//   ∂²g/∂q_k ∂q_l = w_k × ∂g/∂q_l + A_k × d_l + V_k × ∂g/∂v_l
//   ∂²g/∂q_k ∂v_l = w_k × ∂g/∂v_l + 2 V_k × d_l
//   ∂²g/∂v_k ∂q_l = w_k × ∂g/∂v_l + (V_k + Ω_after × w_k) × d_l
//   ∂²g/∂q_k ∂a_l = ∂²g/∂a_k ∂q_l = w_k × d_l,     ∂²g/∂v_k ∂v_l = 2 w_k × d_l
// Contracted with a force, these are products of three vectors of l with vectors of k. Within the base (V = 0) both
// orders of ∂²g/∂v ∂v are added, and the Hessian along q ⊕ d is the mean of both orders of ∂²g/∂q ∂q.
void PointKinematics::add_acceleration_hessian_qq(const Eigen::VectorXd& lambda, Eigen::Ref<Eigen::MatrixXd> qq) const {
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = lambda.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t l = kFirstRotation; l < chain.size(); ++l) {
      const Link& link = chain[l];
      const Vector3d on_w = link.dg_dq.cross(force), on_A = link.d.cross(force), on_V = link.dg_dv.cross(force);
      const bool in_base = l < kBaseDofs;
      for (std::size_t k = kFirstRotation; k < (in_base ? kBaseDofs : l); ++k) {
        const Link& before = chain[k];
        double value = before.w.dot(on_w);
        if (in_base) value *= 0.5;
        if (k >= kBaseDofs) value += before.A().dot(on_A) + before.V().dot(on_V);
        qq(before.dof, link.dof) += value;
        qq(link.dof, before.dof) += value;
      }
      if (!in_base) qq(link.dof, link.dof) += link.w.dot(on_w) + link.A().dot(on_A) + link.V().dot(on_V);
    }
  }
}

void PointKinematics::add_acceleration_hessian(const Eigen::VectorXd& lambda, double velocity_gain,
                                               SecondDerivatives& result) const {
  add_acceleration_hessian_qq(lambda, result.qq);
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = lambda.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t l = 0; l < kBaseDofs; ++l) {
      const Link& link = chain[l];
      const Vector3d on_w = link.dg_dv.cross(force), on_d = link.d.cross(force);
      for (std::size_t k = kFirstRotation; k < kBaseDofs; ++k) {
        const Link& other = chain[k];
        const double value = other.w.dot(on_d);
        result.vv(other.dof, link.dof) += value;
        result.vv(link.dof, other.dof) += value;
        result.qa(other.dof, link.dof) += value;
        result.qv(other.dof, link.dof) += other.w.dot(on_w) + velocity_gain * value;
      }
    }
    for (std::size_t l = kBaseDofs; l < chain.size(); ++l) {
      const Link& link = chain[l];
      const Vector3d on_w = link.dg_dv.cross(force), on_d = link.d.cross(force);
      for (std::size_t k = kFirstRotation; k <= l; ++k) {
        const Link& before = chain[k];
        const double value = before.w.dot(on_d), both = before.w.dot(on_w) + velocity_gain * value;
        const double on_V = k < kBaseDofs ? 0.0 : before.V().dot(on_d);
        result.vv(before.dof, link.dof) += 2.0 * value;
        result.qa(before.dof, link.dof) += value;
        result.qv(before.dof, link.dof) += both + 2.0 * on_V;
        if (k == l) continue;
        result.vv(link.dof, before.dof) += 2.0 * value;
        result.qa(link.dof, before.dof) += value;
        result.qv(link.dof, before.dof) += both + on_V + before.omega_after.cross(before.w).dot(on_d);
      }
    }
  }
}

void PointKinematics::add_force_derivative(const Eigen::VectorXd& f, Eigen::MatrixXd& out) const {
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = f.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t j = 0; j < chain.size(); ++j) {
      const Link& link = chain[j];
      const Vector3d on_w = link.d.cross(force);
      const bool in_base = j < kBaseDofs;
      for (std::size_t i = kFirstRotation; i < (in_base ? kBaseDofs : j + 1); ++i) {
        const double value = chain[i].w.dot(on_w);
        out(link.dof, chain[i].dof) += value;
        if (!in_base && i < j) out(chain[i].dof, link.dof) += value;
      }
    }
  }
}

void PointKinematics::add_position_hessian(const Eigen::VectorXd& lambda, double scale,
                                           Eigen::Ref<Eigen::MatrixXd> out) const {
  for (std::size_t c = 0; c < chains_.size(); ++c) {
    const Vector3d force = scale * lambda.segment<3>(static_cast<Eigen::Index>(3 * c));
    const Chain& chain = chains_[c];
    for (std::size_t l = kFirstRotation; l < chain.size(); ++l) {
      const Link& link = chain[l];
      const Vector3d on_w = link.d.cross(force);
      const bool in_base = l < kBaseDofs;
      for (std::size_t k = kFirstRotation; k < (in_base ? kBaseDofs : l + 1); ++k) {
        const double value = (in_base ? 0.5 : 1.0) * chain[k].w.dot(on_w);  // base rotations: mean of both orders
        out(chain[k].dof, link.dof) += value;
        if (in_base || k < l) out(link.dof, chain[k].dof) += value;
      }
    }
  }
}

}  // namespace prowl

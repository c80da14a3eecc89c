#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/dynamics/inverse_dynamics_hessian.hpp"
#include "prowl/model/body_placements.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Centre of mass and momentum of a robot, with exact first and second derivatives:
///
///   r = com(q)         [m], world frame
///   A_G(q) v           (linear [kg m/s], angular about the centre of mass [kg m^2/s]), world axes
///
/// (Orin, Goswami, Lee, "Centroidal dynamics of a humanoid robot", 2013.) Derivatives in q are with
/// respect to the tangent of configuration.hpp. (P, k0): momentum about the base origin o; r: from
/// o; I_i, B_i: inertia and momentum of the subtree behind joint i; S_i: its motion at v_i = 1;
/// V_i: velocity of the body before it. Then
///
///   angular part = k0 - r x P
///   d(P, k0)/dv_i = I_i S_i,    d(P, k0)/dq_i = F_i = S_i x* B_i + I_i (V_i x S_i)
///
/// since joint i moves its subtree, but not V_i. Likewise, for l at or before i in the chain, E_l =
/// V_l x S_l and any fixed motion y:
///
///   d2 y.(P, k0) / dq_l dq_i = (y x S_l).F_i + E_l.N_i,    N_i = I_i (y x S_i) + S_i x* I_i y
///   d2 y.(P, k0) / dq_l dv_i = (y x S_l).I_i S_i,          d2 y.(P, k0) / dv_l dq_i = S_l.N_i
class CentroidalKinematics {
 public:
  using Vector3 = Eigen::Vector3d;
  using Columns3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;

  explicit CentroidalKinematics(const RobotModel& robot);

  /// Sets q (nq) and v (nv) and evaluates the rest.
  void update(const Eigen::VectorXd& q, const Eigen::VectorXd& v);

  const Vector3& com() const { return com_; }         ///< r, world frame [m]
  const Columns3& com_dq() const { return com_dq_; }  ///< 3 x nv
  const SpatialVector& momentum() const { return momentum_; }
  const SpatialColumns& momentum_dq() const { return momentum_dq_; }  ///< 6 x nv
  const SpatialColumns& momentum_dv() const { return momentum_dv_; }  ///< A_G, 6 x nv

  /// Adds the second derivatives of  on_com . r + on_momentum . A_G v  (linear in v) to nv x nv
  /// blocks; entry (i, j) of qv: in q_i and v_j.
  void add_hessian(const Vector3& on_com, const SpatialVector& on_momentum, Eigen::Ref<Eigen::MatrixXd> qq,
                   Eigen::Ref<Eigen::MatrixXd> qv) const;

 private:
  struct Link {
    SpatialVector before = SpatialVector::Zero(), velocity;  ///< of the body before the joint; of the body
    WorldInertia inertia;                                    ///< of the subtree behind the joint
    SpatialVector momentum;                                  ///< likewise
  };
  void set_motion(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  void add_up();
  const Link& link_of(Eigen::Index dof) const { return links_[dof < 6 ? 0 : static_cast<std::size_t>(dof - 5)]; }

  BodyTree tree_;
  BodyPlacements placements_;
  double mass_;
  std::vector<Link> links_;  ///< per body; the "joint" of the base moves everything
  SpatialColumns S_, E_;     ///< motions about the base's origin, world axes
  SpatialColumns I_S_, F_;   ///< d(P, k0)/dv, d(P, k0)/dq
  Vector3 com_, arm_;        ///< arm: from the base origin to the centre of mass
  Columns3 com_dq_;
  SpatialVector momentum_;
  SpatialColumns momentum_dq_, momentum_dv_;
};

}  // namespace prowl

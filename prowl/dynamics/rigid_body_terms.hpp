#pragma once

#include <Eigen/Core>
#include <memory>
#include <vector>

#include "prowl/dynamics/inverse_dynamics_hessian.hpp"
#include "prowl/model/robot_model.hpp"

namespace prowl {

/// A vector that is fixed to a body of the robot.
struct BodyPoint {
  enum class Kind { point, direction };               ///< a direction only turns with the body
  int body = 0;                                       ///< index into BodyTree::bodies
  Eigen::Vector3d in_body = Eigen::Vector3d::Zero();  ///< in the body's frame [m]; of a direction any length
  Kind kind = Kind::point;
};

/// Terms of the rigid-body dynamics without contacts, by Pinocchio.
///
///   r0(q, v, a) = RNEA = M(q) a + h(q, v)      [N, N m], n + 6 rows: force and moment on the base (base frame), joints
///
/// Derivatives in q are with respect to the tangent of configuration.hpp (world displacement of the base, rotation
/// vector in the base frame, joints). One object holds the work space of one thread; results stay until the next
/// update.
class RigidBodyTerms {
 public:
  explicit RigidBodyTerms(const RobotModel& robot);
  ~RigidBodyTerms();
  RigidBodyTerms(RigidBodyTerms&&) noexcept;

  int nv() const { return nv_; }

  /// Inverse dynamics and the kinematics below.
  void update(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a);
  /// The same and all first derivatives.
  void update_with_derivatives(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a);
  /// Kinematics only.
  void update_kinematics(const Eigen::VectorXd& q);

  const Eigen::VectorXd& inverse_dynamics() const { return inverse_dynamics_; }  ///< r0
  const Eigen::MatrixXd& dq() const { return dq_; }                              ///< dr0/dq, nv x nv
  const Eigen::MatrixXd& dv() const { return dv_; }                              ///< dr0/dv, nv x nv
  const Eigen::MatrixXd& mass_matrix() const { return mass_matrix_; }            ///< dr0/da = M, nv x nv

  /// Column j is the spatial velocity of the bodies behind degree of freedom j at v_j = 1, others 0: rows 0-2 the
  /// velocity of the body point at the WORLD origin, rows 3-5 the angular velocity, world axes. 6 x nv.
  const Eigen::Matrix<double, 6, Eigen::Dynamic>& motion_columns() const { return motion_columns_; }
  /// World placement of a body, index into BodyTree::bodies: x in the body is at rotation x + position.
  Eigen::Ref<const Eigen::Matrix3d> body_rotation(int body) const;
  Eigen::Ref<const Eigen::Vector3d> body_position(int body) const;  ///< [m]
  /// Degrees of freedom that move a body: 0 ... 5 (the base), then joints from the base to the body.
  const std::vector<int>& body_chain(int body) const { return chains_[static_cast<size_t>(body)]; }

  const BodyPoint& contact_point(int contact) const { return contacts_[static_cast<size_t>(contact)]; }
  Eigen::Vector3d contact_position(int contact) const;  ///< world frame [m]; contact of the robot
  /// Degrees of freedom that move a contact.
  const std::vector<int>& contact_chain(int contact) const { return body_chain(contact_point(contact).body); }

  /// Adds the second derivatives of lambda . r0 at fixed lambda (nv) [any unit]. Requires update_with_derivatives(),
  /// whose by-products it uses.
  void add_second_derivatives(const Eigen::VectorXd& lambda, SecondDerivatives& result);

 private:
  struct Workspace;  // Pinocchio's Data
  void fetch_kinematics();

  int nv_;
  std::unique_ptr<Workspace> workspace_;
  std::vector<std::vector<int>> chains_;  ///< of the bodies
  std::vector<BodyPoint> contacts_;
  Eigen::VectorXd inverse_dynamics_;
  Eigen::MatrixXd dq_, dv_, mass_matrix_;
  Eigen::Matrix<double, 6, Eigen::Dynamic> motion_columns_;
};

}  // namespace prowl

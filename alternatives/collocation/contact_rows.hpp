#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Rows about the contacts that a phase holds, beside those of NodeFunctions, in this order, each where it is asked
/// for:
///
///   distance       n · (p − point) − radius       1 a contact, over the size of the robot
///   velocity       J v                            3 a contact, over √(g size)
///   acceleration   J a + J̇ v + kd J v + kp (p − anchor)   3 a contact, over g
class ContactRows {
 public:
  struct Kinds {
    bool distance = false, velocity = false, acceleration = false;
    double tolerance = 0.0;  ///< of distances [m]
  };
  ContactRows(const MotionProblem& problem, int phase, Kinds kinds);

  int count() const { return distances() + velocities() + accelerations(); }
  int distances() const { return kinds_.distance ? num_contacts() : 0; }
  int first_acceleration() const { return distances() + velocities(); }  ///< row; the others are about single nodes
  /// Of a row, either way.
  double tolerance(int row) const { return row < distances() ? kinds_.tolerance / length_ : 0.0; }
  std::string describe(int row) const;

  /// Where it is evaluated: `terms` at the point's q; v, a and anchors of the point, its gains.
  void evaluate(const RigidBodyTerms& terms, const DynamicsPoint& at, Eigen::Ref<Eigen::VectorXd> values);
  /// After evaluate() there: derivatives in the tangent of q, in v, in a, in the anchors and in the gains (kd, kp). Set
  /// whole.
  struct Derivatives {
    Eigen::MatrixXd q, v, a, anchors, gains;
  };
  void derivatives(const DynamicsPoint& at, Derivatives& result);
  /// After derivatives(): second derivatives of multipliers . rows.
  struct Hessian : SecondDerivatives {
    using SecondDerivatives::SecondDerivatives;
    Eigen::MatrixXd qgains, vgains;  ///< two columns, kd and kp
    Eigen::VectorXd de;              ///< multipliers of the accelerations; that of kp and the anchors is -de
  };
  /// After hessian(): first derivatives of multipliers . rows in kd and kp.
  Eigen::Vector2d on_gains(const DynamicsPoint& at) const {
    return {hessian_.vgains.col(0).dot(at.v), hessian_.de.dot(kinematics_.positions() - at.anchors)};
  }
  const Hessian& hessian(const DynamicsPoint& at, const Eigen::VectorXd& multipliers);

 private:
  int num_contacts() const { return static_cast<int>(normals_.size()); }
  int velocities() const { return kinds_.velocity ? 3 * num_contacts() : 0; }
  int accelerations() const { return kinds_.acceleration ? 3 * num_contacts() : 0; }

  Kinds kinds_;
  double length_, speed_, acceleration_;
  std::vector<std::string> names_;
  std::vector<Eigen::Vector3d> normals_;
  std::vector<double> offsets_;  ///< normal . point + radius
  ContactKinematics kinematics_;
  Eigen::VectorXd at_rest_;
  Hessian hessian_;
};

}  // namespace prowl

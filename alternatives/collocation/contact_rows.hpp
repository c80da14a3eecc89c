#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/dynamics/contact_kinematics.hpp"
#include "prowl/dynamics/projected_residual.hpp"
#include "prowl/motion/motion_problem.hpp"

namespace prowl {

/// Optional rows for the contacts of a phase, in addition to those of NodeFunctions, in this order:
///
///   distance       n · (p − point) − radius               1 per contact, over the size of the robot
///   velocity       J v                                    3 per contact, over √(g size)
///   acceleration   J a + J̇ v + kd J v + kp (p − anchor)   3 per contact, over g
class ContactRows {
 public:
  struct Kinds {
    bool distance = false, velocity = false, acceleration = false;
    double tolerance = 0.0;  ///< of distances [m]
  };
  ContactRows(const MotionProblem& problem, int phase, Kinds kinds);

  int count() const { return distances() + velocities() + accelerations(); }
  int distances() const { return kinds_.distance ? num_contacts() : 0; }
  int first_acceleration() const { return distances() + velocities(); }  ///< row; those before hold at nodes only
  /// Tolerance of a row, both ways.
  double tolerance(int row) const { return row < distances() ? kinds_.tolerance / length_ : 0.0; }
  std::string describe(int row) const;

  /// `terms`: at the configuration of `at`; uses v, a, anchors and gains of `at`.
  void evaluate(const RigidBodyTerms& terms, const DynamicsPoint& at, Eigen::Ref<Eigen::VectorXd> values);
  /// After evaluate() at the same point: derivatives in the tangent of q, v, a, anchors and gains
  /// (kd, kp); overwrites all entries.
  struct Derivatives {
    Eigen::MatrixXd q, v, a, anchors, gains;
  };
  void derivatives(const DynamicsPoint& at, Derivatives& result);
  /// After derivatives(): second derivatives of multipliers . rows.
  struct Hessian : SecondDerivatives {
    using SecondDerivatives::SecondDerivatives;
    Eigen::MatrixXd qgains, vgains;  ///< two columns, kd and kp
    Eigen::VectorXd de;              ///< multipliers of the accelerations; the kp-anchor block is -de
  };
  /// After hessian(): first derivatives of multipliers . rows in (kd, kp).
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

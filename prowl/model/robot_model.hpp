#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "prowl/model/joint_losses.hpp"
#include "prowl/model/robot_description.hpp"

namespace prowl {

struct PinocchioModel;  // model/pinocchio_model.hpp; only model, dynamics and the certificate look inside

/// A legged robot: rigid bodies on a floating base, and its limits. Immutable; copies are deep.
///
/// Configuration q = (base position in the world [m], base quaternion x y z w, joint positions), nq = 7 + nu.
/// Velocity v = (linear, angular velocity of the base in the base frame [m/s, rad/s], joint rates), nv = 6 + nu.
/// Every joint but the base has one degree of freedom and an actuator: nu = nv - 6.
/// Joints are in Pinocchio's order (see joint_names).
class RobotModel {
 public:
  /// Reads the URDF, checks it and the description against each other, and puts the nominal posture on the ground:
  /// the ball of the lowest contact touches z = 0, and the mean of all contact points is at x = y = 0.
  /// Throws FileError (URDF unreadable) or InputError (anything wrong in it, or an unknown name).
  explicit RobotModel(RobotDescription description);
  RobotModel(const RobotModel& other);
  RobotModel(RobotModel&&) noexcept;
  RobotModel& operator=(RobotModel other) noexcept;
  ~RobotModel();

  const RobotDescription& description() const { return description_; }  ///< with the text of the URDF
  const std::string& name() const { return description_.name; }
  int nq() const { return nv() + 1; }
  int nv() const { return 6 + nu(); }
  int nu() const { return static_cast<int>(joint_names_.size()); }
  double mass() const { return mass_; }               ///< [kg]
  double weight() const { return mass_ * kGravity; }  ///< [N]

  const std::vector<std::string>& joint_names() const { return joint_names_; }  ///< nu names
  const std::vector<bool>& joint_is_prismatic() const { return joint_is_prismatic_; }
  const Eigen::VectorXd& position_lower() const { return position_lower_; }  ///< nu [rad]; -inf where none
  const Eigen::VectorXd& position_upper() const { return position_upper_; }  ///< nu [rad]; +inf where none
  const Eigen::VectorXd& velocity_limit() const { return velocity_limit_; }  ///< nu [rad/s]; +inf where none
  const Eigen::VectorXd& torque_limit() const { return torque_limit_; }      ///< nu [N m]; +inf where none
  Eigen::VectorXd armature() const;                                          ///< nu [kg m^2], see RobotDescription
  const JointLosses& losses() const { return losses_; }                      ///< damping and dry friction
  /// Torque limits that depend on the state, besides torque_limit(): -negative(q) <= tau <= positive(q) of one joint,
  /// and -negative(-v) <= tau <= positive(v), where both are the same curve.
  struct TorqueCurve {
    int joint = 0;  ///< 0 ... nu - 1
    bool over_velocity = false;
    LimitCurve positive, negative;

    double upper(double position, double velocity) const { return positive.value(over_velocity ? velocity : position); }
    double lower(double position, double velocity) const {
      return -negative.value(over_velocity ? -velocity : position);
    }
  };
  const std::vector<TorqueCurve>& torque_curves() const { return torque_curves_; }
  /// Largest and smallest torque of a motor at this position and velocity of its joint, from all limits [N m].
  double torque_upper(int joint, double position, double velocity) const;
  double torque_lower(int joint, double position, double velocity) const;

  const std::vector<ContactPoint>& contacts() const { return description_.contacts; }
  /// Index of a contact by name; throws InputError that names the nearest.
  int contact_index(const std::string& name) const;

  const Eigen::VectorXd& nominal_configuration() const { return nominal_configuration_; }  ///< nq

  /// Size of the robot: RMS distance of its contact points from the base in the nominal posture [m], at least 1 cm.
  double size() const { return size_; }

  const PinocchioModel& pinocchio() const { return *pinocchio_; }

  static constexpr double kGravity = 9.81;  ///< [m/s^2], Pinocchio's default

 private:
  void add_torque_curves(const std::string& name, int joint, const JointLimits& limits);
  void check_torque_curves() const;

  RobotDescription description_;
  std::unique_ptr<const PinocchioModel> pinocchio_;
  std::vector<std::string> joint_names_;
  std::vector<bool> joint_is_prismatic_;
  Eigen::VectorXd position_lower_, position_upper_, velocity_limit_, torque_limit_;
  std::vector<TorqueCurve> torque_curves_;
  JointLosses losses_;
  Eigen::VectorXd nominal_configuration_;
  double mass_ = 0.0;
  double size_ = 1.0;
};

/// Joints of the URDF that move no mass, alone or with others, and that only RobotDescription::locked_joints makes
/// sound. Throws as RobotModel for a URDF that cannot be read.
std::vector<std::string> massless_joints(RobotDescription description);

}  // namespace prowl

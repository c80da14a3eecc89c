#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {

struct CollisionShapes;

/// Differences between the simulated and the planned robot and ground.
struct PhysicsOptions {
  double step = 5e-4;                    ///< [s]
  double mass_scale = 1.0;               ///< factor on masses and inertias of all bodies
  std::vector<double> body_scales = {};  ///< the same of each body (BodyTree::bodies), besides; empty: 1
  Eigen::Vector3d base_center = Eigen::Vector3d::Zero();  ///< displacement of the base's centre of mass, its axes [m]
  std::optional<double> friction = {};                    ///< replaces the coefficient of every surface
  double friction_scale = 1.0;                            ///< factor on these coefficients
  /// What touches besides the contacts (collision_shapes()); null: nothing does.
  std::shared_ptr<const CollisionShapes> collisions = {};
};

/// State of one contact during the last step.
struct ContactReading {
  bool touches = false;                                ///< with a force above 0
  int surface = -1;                                    ///< index; of the largest force; -1 without touch
  Eigen::Vector3d force = Eigen::Vector3d::Zero();     ///< on the robot, world frame [N]
  double load = 0.0;                                   ///< part of the force along the normals of what it touches [N]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< of the contact point, world frame [m]
  /// Velocity of the touching material along the surface, world frame [m/s]; zero for a rolling
  /// ball.
  Eigen::Vector3d slip_velocity = Eigen::Vector3d::Zero();
};

/// The robot on its surfaces in MuJoCo, with MuJoCo's kinematics, contact and integration; nothing
/// of prowl/dynamics.
///
/// The model contains the bodies (links on fixed joints are merged), the joint limits, the
/// surfaces, one ball per contact: of the contact's radius, or of 1 mm for corners of flat
/// feet, with its lowest point at the corner; and collision shapes. Joints have damping and friction of
/// the URDF. q, v, tau and frames as in RobotModel; docs/simulation.md maps the conventions.
class Physics {
 public:
  /// Throws InputError with MuJoCo's reason if it rejects the robot.
  Physics(const RobotModel& robot, const std::vector<Surface>& surfaces, const PhysicsOptions& options);
  Physics(Physics&&) noexcept;
  ~Physics();

  double step_size() const;  ///< [s]
  double mass() const;       ///< of the simulated robot [kg]
  void set_state(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }

  /// One step with joint torques tau (nu, not limited) and a force on the base's centre of mass,
  /// world axes [N]. False if torques or result are not finite: end the simulation.
  bool step(const Eigen::VectorXd& tau, const Eigen::Vector3d& push = Eigen::Vector3d::Zero());

  /// One per contact of the robot.
  const std::vector<ContactReading>& contacts() const { return contacts_; }
  /// What touched during the last step without being a contact on a surface, as "trunk and floor"; "" if nothing did.
  const std::string& other_touch() const { return other_touch_; }
  /// Places of the contacts in a configuration, world frame [m].
  std::vector<Eigen::Vector3d> contact_positions(const Eigen::VectorXd& q) const;
  /// Velocity of a contact's point, world frame, over v (3 x nv), in the configuration of the latest
  /// contact_positions().
  Eigen::MatrixXd contact_jacobian(int contact) const;
  double contact_radius(int contact) const;  ///< of its ball [m]

  /// For comparison, at the state set last, without contacts: mass matrix (nv x nv) and bias force
  /// (nv), M a + h = forces.
  Eigen::MatrixXd mass_matrix();
  Eigen::VectorXd bias();

  static const char* version();  ///< of MuJoCo

 private:
  void read_state();
  void read_contacts();

  struct Engine;
  std::unique_ptr<Engine> engine_;
  Eigen::VectorXd q_, v_;
  std::vector<ContactReading> contacts_;
  std::string other_touch_;
};

}  // namespace prowl

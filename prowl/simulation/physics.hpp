#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/surface.hpp"

namespace prowl {

/// What may differ between the robot and ground that are simulated and those that were planned for.
struct PhysicsOptions {
  double step = 5e-4;                   ///< [s]
  double mass_scale = 1.0;              ///< on the masses and inertias of all bodies
  std::optional<double> friction = {};  ///< of every surface, in place of its own
};

/// How one contact of the robot stood during the last step.
struct ContactReading {
  bool touches = false;                             ///< with a force above 0
  int surface = -1;                                 ///< of the largest force; -1 without touch
  Eigen::Vector3d force = Eigen::Vector3d::Zero();  ///< on the robot, world frame [N]
  /// Of the material that touches, along the surface [m/s]: zero for a ball that rolls.
  Eigen::Vector3d slip_velocity = Eigen::Vector3d::Zero();
};

/// The robot on its surfaces in MuJoCo: its own kinematics, inertias, contact and integration; nothing of
/// prowl/dynamics.
///
/// The model has the bodies of the robot with the inertias of links that fixed joints hold together in one, its joint
/// limits, a ball for each contact (of a contact's radius; 1 mm for the corners of flat feet, whose lowest point is the
/// corner), the surfaces, and no contact between parts of the robot. No joint damping and no joint friction: the plan
/// has none. q, v, tau and the frames as in RobotModel; docs/simulation.md has the map between the two conventions.
class Physics {
 public:
  /// Throws InputError, with MuJoCo's reason, for a robot that it cannot have.
  Physics(const RobotModel& robot, const std::vector<Surface>& surfaces, const PhysicsOptions& options);
  Physics(Physics&&) noexcept;
  ~Physics();

  double step_size() const;
  double mass() const;  ///< of the simulated robot [kg]
  void set_state(const Eigen::VectorXd& q, const Eigen::VectorXd& v);
  const Eigen::VectorXd& q() const { return q_; }
  const Eigen::VectorXd& v() const { return v_; }

  /// One step with joint torques tau (nu, as they are: no limit) and a force on the base's centre of mass [N], world
  /// axes. False if the torques or the result are not finite: then it is over.
  bool step(const Eigen::VectorXd& tau, const Eigen::Vector3d& push = Eigen::Vector3d::Zero());

  /// One for each contact of the robot.
  const std::vector<ContactReading>& contacts() const { return contacts_; }

  /// At the state set last, without contacts: mass matrix (nv x nv) and bias force (nv), M a + h = forces; to compare.
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
};

}  // namespace prowl

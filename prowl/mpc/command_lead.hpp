#pragma once

#include <Eigen/Core>

#include "prowl/mpc/ground_plane.hpp"
#include "prowl/mpc/horizon_grid.hpp"
#include "prowl/mpc/horizon_program.hpp"

namespace prowl {

/// What a robot is asked to do; velocities in the frame of its heading. Changes are smoothed.
struct MpcCommand {
  double forward = 0.0, left = 0.0;  ///< [m/s]
  double turn = 0.0;                 ///< about the vertical [rad/s]
  double height = 0.0;               ///< of the base, from its standing height [m]

  bool operator==(const MpcCommand&) const = default;
};

/// Reference pose, integrated from the commands, and references of a horizon from there.
class CommandLead {
 public:
  /// `standing` (nq): posture of all references, which must outlive this. At time t [s] the robot is at q, and stays.
  CommandLead(const Eigen::VectorXd& standing, const Eigen::VectorXd& q, double t);

  /// Returns the command that is followed: within the speeds that the legs allow, without velocity while the robot
  /// stands; 0 for a part that is not finite.
  MpcCommand command(const MpcCommand& command);
  /// Whether the robot stands, as it does at first. The latest command is followed anew.
  void stand(bool stands);
  /// Command after smoothing.
  const MpcCommand& followed() const { return smooth_; }
  /// Place (x, y) [m] and heading [rad] to which the commands have led.
  Eigen::Vector3d pose() const { return {place_.x(), place_.y(), heading_}; }
  /// Integrates commands to time `start` [s].
  void advance(double start);
  /// The same, and sets the references of a horizon that begins then.
  void lead(double start, const HorizonGrid& grid, const GroundPlane& ground, HorizonProgram& program);
  /// Keeps the reference pose near a robot at q, `size` [m] large.
  void stay_near(const Eigen::VectorXd& q, double size);

 private:
  const Eigen::VectorXd& standing_;
  MpcCommand asked_, command_, smooth_;
  bool stands_ = true;
  double led_until_;       ///< [s]
  Eigen::Vector2d place_;  ///< world [m]
  double heading_;         ///< [rad]
};

}  // namespace prowl

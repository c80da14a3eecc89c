#pragma once

namespace prowl {

/// Weights of the cost of a horizon. All are dimensionless: lengths are divided by the size l of the robot, forces by
/// its weight m g, times by sqrt(l / g), so that they serve robots of any size.
struct MpcWeights {
  // Of the running cost.
  double place = 2.0;             ///< base, horizontal, from where the command leads
  double height = 20.0;           ///< base
  double tilt = 20.0;             ///< roll and pitch
  double heading = 10.0;          ///< yaw
  double posture = 0.5;           ///< joints from the standing posture
  double posture_of_biped = 5.0;  ///< the same for a robot on two feet, whose legs would cross
  double velocity = 25.0;         ///< base, from the command
  double climb = 15.0;            ///< base, vertical velocity
  double turning = 3.0;           ///< base, angular velocity from the command
  double joint_rate = 0.01;
  double acceleration = 1e-3;  ///< of base and joints
  double torque = 0.05;
  double force = 0.15;
  /// Factor on those of the state, as a cost of the end, times sqrt(l / g). Others were tried for the horizontal motion
  /// of the base. Survived of 12 runs with kicks of 1.2 m/s every 2 s, HyQ and Go2: this one 12 and 10; the stationary
  /// Riccati solution of a double integrator 12 and 11; the distance of the capture point, weighted by 5: 12 and 9, and
  /// by 25: 12 and 9.
  double terminal = 1.0;
  // Exact penalty of soft limits, per unit: larger than any multiplier of a motion that keeps them.
  double penalty = 30.0;
};

}  // namespace prowl

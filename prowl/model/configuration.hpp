#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace prowl {

/// Configurations live on R^3 x SO(3) x R^n: add and subtract them only with these two functions.
/// The tangent is (displacement of the base in the WORLD frame, rotation vector in the base frame, joints):
///   q (+) d = (p + d_p, R exp(d_R), joints + d_j)
/// Note that the base part of a velocity v is in the base frame: the displacement of a small step dt is R v_lin dt.
Eigen::VectorXd integrate(const Eigen::VectorXd& q, const Eigen::VectorXd& tangent);
/// d with q0 (+) d = q1, |d_R| <= pi.
Eigen::VectorXd difference(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1);

inline Eigen::Vector3d base_position(const Eigen::VectorXd& q) { return q.head<3>(); }
inline Eigen::Quaterniond base_quaternion(const Eigen::VectorXd& q) {
  return Eigen::Quaterniond(q(6), q(3), q(4), q(5));
}
inline Eigen::Matrix3d base_rotation(const Eigen::VectorXd& q) { return base_quaternion(q).toRotationMatrix(); }
void set_base_rotation(Eigen::VectorXd& q, const Eigen::Matrix3d& R);
/// R = Rz(yaw) Ry(pitch) Rx(roll), angles (roll, pitch, yaw) [rad].
Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy);
/// Its inverse: pitch in [-pi/2, pi/2]; if |pitch| = pi/2, any roll and yaw that give R.
Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R);
/// Heading of the base: the yaw of its rotation [rad].
inline double heading(const Eigen::VectorXd& q) { return rpy_from_rotation(base_rotation(q)).z(); }

}  // namespace prowl

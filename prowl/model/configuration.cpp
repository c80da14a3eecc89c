#include "prowl/model/configuration.hpp"

#include "prowl/model/so3.hpp"

namespace prowl {

Eigen::VectorXd integrate(const Eigen::VectorXd& q, const Eigen::VectorXd& tangent) {
  Eigen::VectorXd result(q.size());
  result.head<3>() = q.head<3>() + tangent.head<3>();
  const Eigen::Vector3d theta = tangent.segment<3>(3);
  // Product of quaternions, not matrices: the sign of the quaternion never jumps along a motion.
  const Eigen::Quaterniond step(Eigen::AngleAxisd(theta.stableNorm(), theta.stableNormalized()));
  result.segment<4>(3) = (base_quaternion(q) * step).normalized().coeffs();
  result.tail(q.size() - 7) = q.tail(q.size() - 7) + tangent.tail(q.size() - 7);
  return result;
}

Eigen::VectorXd difference(const Eigen::VectorXd& q0, const Eigen::VectorXd& q1) {
  Eigen::VectorXd tangent(q0.size() - 1);
  tangent.head<3>() = q1.head<3>() - q0.head<3>();
  const Eigen::AngleAxisd step(base_quaternion(q0).conjugate() * base_quaternion(q1));
  tangent.segment<3>(3) = step.angle() * step.axis();
  tangent.tail(q0.size() - 7) = q1.tail(q0.size() - 7) - q0.tail(q0.size() - 7);
  return tangent;
}

void set_base_rotation(Eigen::VectorXd& q, const Eigen::Matrix3d& R) {
  q.segment<4>(3) = Eigen::Quaterniond(R).normalized().coeffs();
}

Eigen::Matrix3d rotation_from_rpy(const Eigen::Vector3d& rpy) {
  using Eigen::AngleAxisd, Eigen::Vector3d;
  return (AngleAxisd(rpy.z(), Vector3d::UnitZ()) * AngleAxisd(rpy.y(), Vector3d::UnitY()) *
          AngleAxisd(rpy.x(), Vector3d::UnitX()))
      .toRotationMatrix();
}

Eigen::Vector3d rpy_from_rotation(const Eigen::Matrix3d& R) {
  return {std::atan2(R(2, 1), R(2, 2)), std::atan2(-R(2, 0), std::hypot(R(0, 0), R(1, 0))),
          std::atan2(R(1, 0), R(0, 0))};
}

}  // namespace prowl

#include "prowl/motion/cost.hpp"

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

ConfigurationCost configuration_cost(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& weight,
                                     const Eigen::VectorXd& q) {
  ConfigurationCost cost;
  configuration_cost(q_ref, weight, q, cost);
  return cost;
}

void configuration_cost(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& weight, const Eigen::VectorXd& q,
                        ConfigurationCost& cost) {
  // d = difference(q_ref, q), part by part.
  const Eigen::AngleAxisd rotation(base_quaternion(q_ref).conjugate() * base_quaternion(q));
  const Eigen::Vector3d log = rotation.angle() * rotation.axis();
  cost.gradient.resize(weight.size());
  cost.gradient.head<3>() = q.head<3>() - q_ref.head<3>();
  cost.gradient.segment<3>(3) = log;
  cost.gradient.tail(q.size() - 7) = q.tail(q.size() - 7) - q_ref.tail(q.size() - 7);
  cost.value = 0.5 * cost.gradient.cwiseAbs2().dot(weight);
  cost.gradient.array() *= weight.array();
  cost.hessian_diagonal = weight;

  // The rotation part: d_R = log(R_ref' R exp(x)), so dd_R/dx = Jr^-1(d_R), and along x = t u
  // d_R'' = -Jr^-1 (DJr[w]) w with w = Jr^-1 u.
  const Eigen::Matrix3d inverse = so3::right_jacobian_inverse(log);
  const Eigen::Vector3d pulled = inverse.transpose() * cost.gradient.segment<3>(3);
  cost.gradient.segment<3>(3) = pulled;
  cost.hessian_diagonal.segment<3>(3).setZero();
  cost.hessian_rotation =
      inverse.transpose() *
      (Eigen::Matrix3d(weight.segment<3>(3).asDiagonal()) - so3::right_jacobian_derivative(log, pulled)) * inverse;
}

}  // namespace prowl

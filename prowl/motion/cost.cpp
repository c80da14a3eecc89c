#include "prowl/motion/cost.hpp"

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

ConfigurationCost configuration_cost(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& weight,
                                     const Eigen::VectorXd& q) {
  const Eigen::VectorXd d = difference(q_ref, q);
  ConfigurationCost cost;
  cost.value = 0.5 * d.cwiseAbs2().dot(weight);
  cost.gradient = weight.cwiseProduct(d);
  cost.hessian_diagonal = weight;

  // The rotation part: d_R = log(R_ref' R exp(x)), so dd_R/dx = Jr^-1(d_R), and along x = t u
  // d_R'' = -Jr^-1 (DJr[w]) w with w = Jr^-1 u.
  const Eigen::Vector3d log = d.segment<3>(3);
  const Eigen::Vector3d force = weight.segment<3>(3).cwiseProduct(log);
  const Eigen::Matrix3d inverse = so3::right_jacobian_inverse(log);
  const Eigen::Vector3d pulled = inverse.transpose() * force;
  cost.gradient.segment<3>(3) = pulled;
  cost.hessian_diagonal.segment<3>(3).setZero();
  cost.hessian_rotation =
      inverse.transpose() *
      (Eigen::Matrix3d(weight.segment<3>(3).asDiagonal()) - so3::right_jacobian_derivative(log, pulled)) * inverse;
  return cost;
}

}  // namespace prowl

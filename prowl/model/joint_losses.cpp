#include "prowl/model/joint_losses.hpp"

#include <cmath>

namespace prowl {

double JointLosses::torque(int joint, double rate) const {
  return damping(joint) * rate + dry_friction(joint) * std::tanh(rate / kSlow);
}

double JointLosses::slope(int joint, double rate) const {
  const double part = std::tanh(rate / kSlow);
  return damping(joint) + dry_friction(joint) / kSlow * (1.0 - part * part);
}

double JointLosses::curvature(int joint, double rate) const {
  const double part = std::tanh(rate / kSlow);
  return -2.0 * dry_friction(joint) / (kSlow * kSlow) * part * (1.0 - part * part);
}

Eigen::VectorXd JointLosses::torques(const Eigen::VectorXd& rates) const {
  Eigen::VectorXd result(rates.size());
  for (Eigen::Index j = 0; j < rates.size(); ++j) result(j) = torque(static_cast<int>(j), rates(j));
  return result;
}

}  // namespace prowl

#include "prowl/motion/friction_limit.hpp"

#include <numbers>

namespace prowl {

FrictionLimit::FrictionLimit(FrictionModel model, const Surface& surface, double smoothing, double least) {
  if (model == FrictionModel::cone) {
    cone_ = FrictionCone{surface.normal, surface.friction, smoothing};
    return;
  }
  const Eigen::RowVector3d normal = surface.friction / std::numbers::sqrt2 * surface.normal.transpose();
  const Eigen::Matrix<double, 2, 3> tangents = surface.axes().transpose();
  planes_ << normal - tangents.row(0), normal + tangents.row(0), normal - tangents.row(1), normal + tangents.row(1);
  offset_ = surface.friction / std::numbers::sqrt2 * least;
}

FrictionLimit::Rows FrictionLimit::rows(const Eigen::Vector3d& force) const {
  if (cone_) return Rows::Constant(1, cone_->value(force));
  return (planes_ * force).array() - offset_;
}

FrictionLimit::Slopes FrictionLimit::slopes(const Eigen::Vector3d& force) const {
  if (cone_) return cone_->gradient(force).transpose();
  return planes_;
}

Eigen::Matrix3d FrictionLimit::curvature(const Eigen::Vector3d& force,
                                         const Eigen::Ref<const Eigen::VectorXd>& multipliers) const {
  if (cone_) return multipliers(0) * cone_->hessian(force);
  return Eigen::Matrix3d::Zero();
}

}  // namespace prowl

#include "prowl/dynamics/inertia_errors.hpp"

#include <pinocchio/algorithm/regressor.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

struct InertiaErrors::Workspace {
  PinocchioModel pin;
  pinocchio::Data data;
};

InertiaErrors::InertiaErrors(const RobotModel& robot)
    : workspace_(new Workspace{robot.pinocchio(), pinocchio::Data(robot.pinocchio().model)}),
      bodies_(robot.pinocchio().model.njoints - 1) {}

InertiaErrors::InertiaErrors(InertiaErrors&&) noexcept = default;
InertiaErrors::~InertiaErrors() = default;

Eigen::MatrixXd InertiaErrors::forces(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& a,
                                      double mass, double center) {
  const pinocchio::Model& model = workspace_->pin.model;
  const auto& regressor = pinocchio::computeJointTorqueRegressor(model, workspace_->data, q, v, a);
  constexpr Eigen::Index kParameters = 10;  // of a body
  Eigen::MatrixXd result(model.nv, count());
  for (int b = 0; b < bodies_; ++b) {
    const auto joint = static_cast<pinocchio::JointIndex>(b) + kBaseJoint;
    result.col(b) =
        regressor.middleCols<kParameters>(kParameters * b) * (mass * model.inertias[joint].toDynamicParameters());
  }
  const pinocchio::Inertia& base = model.inertias[kBaseJoint];
  for (int axis = 0; axis < 3; ++axis) {
    pinocchio::Inertia moved = base;
    moved.lever()(axis) += center;
    result.col(bodies_ + axis) =
        regressor.leftCols<kParameters>() * (moved.toDynamicParameters() - base.toDynamicParameters());
  }
  return result;
}

}  // namespace prowl

#include "prowl/model/leg_kinematics.hpp"

#include <pinocchio/algorithm/frames.hpp>
#include <pinocchio/algorithm/jacobian.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

struct LegKinematics::Workspace {
  PinocchioModel pin;
  pinocchio::Data data;
  Eigen::VectorXd q;
  Eigen::Matrix<double, 6, Eigen::Dynamic> jacobian;
};

LegKinematics::LegKinematics(const RobotModel& robot)
    : workspace_(new Workspace{
          robot.pinocchio(), pinocchio::Data(robot.pinocchio().model), Eigen::VectorXd::Zero(robot.nq()), {}}),
      positions_(robot.contacts().size(), Eigen::Vector3d::Zero()),
      linear_(robot.contacts().size(), Eigen::Matrix3Xd::Zero(3, robot.nu())),
      angular_(robot.contacts().size(), Eigen::Matrix3Xd::Zero(3, robot.nu())) {
  workspace_->q(6) = 1.0;  // the base stays at the origin: world axes are base axes
  workspace_->jacobian.setZero(6, robot.nv());
  update(robot.nominal_configuration().tail(robot.nu()));
}

LegKinematics::LegKinematics(LegKinematics&&) noexcept = default;
LegKinematics::~LegKinematics() = default;

void LegKinematics::update(const Eigen::VectorXd& joints) {
  Workspace& w = *workspace_;
  w.q.tail(joints.size()) = joints;
  pinocchio::computeJointJacobians(w.pin.model, w.data, w.q);
  pinocchio::updateFramePlacements(w.pin.model, w.data);
  for (std::size_t c = 0; c < positions_.size(); ++c) {
    const pinocchio::FrameIndex frame = w.pin.contact_frames[c];
    positions_[c] = w.data.oMf[frame].translation();
    w.jacobian.setZero();
    pinocchio::getFrameJacobian(w.pin.model, w.data, frame, pinocchio::LOCAL_WORLD_ALIGNED, w.jacobian);
    linear_[c] = w.jacobian.topRightCorner(3, joints.size());
    angular_[c] = w.jacobian.bottomRightCorner(3, joints.size());
  }
}

}  // namespace prowl

#include "prowl/model/body_placements.hpp"

#include <pinocchio/algorithm/kinematics.hpp>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

struct BodyPlacements::Workspace {
  const pinocchio::Model& model;
  pinocchio::Data data;
};

BodyPlacements::BodyPlacements(const RobotModel& robot)
    : workspace_(new Workspace{robot.pinocchio().model, pinocchio::Data(robot.pinocchio().model)}),
      placements_(robot.pinocchio().model.joints.size() - 1, Eigen::Isometry3d::Identity()) {}

BodyPlacements::~BodyPlacements() = default;
BodyPlacements::BodyPlacements(BodyPlacements&&) noexcept = default;

const std::vector<Eigen::Isometry3d>& BodyPlacements::at(const Eigen::VectorXd& q) {
  pinocchio::forwardKinematics(workspace_->model, workspace_->data, q);
  for (std::size_t b = 0; b < placements_.size(); ++b) {
    const pinocchio::SE3& placement = workspace_->data.oMi[b + 1];  // 0 is the world
    placements_[b].linear() = placement.rotation();
    placements_[b].translation() = placement.translation();
  }
  return placements_;
}

}  // namespace prowl

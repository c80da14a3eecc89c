#include "prowl/model/locked_joints.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <numeric>
#include <pinocchio/algorithm/crba.hpp>
#include <pinocchio/algorithm/joint-configuration.hpp>
#include <pinocchio/algorithm/model.hpp>
#include <set>

#include "prowl/model/description_error.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

namespace {

constexpr double kLeastInertia = 1e-7;  // eigenvalue of the mass matrix with ones on its diagonal: half of the digits

}  // namespace

std::vector<std::string> moving_joints(const pinocchio::Model& model) {
  return {model.names.begin() + kBaseJoint + 1, model.names.end()};
}

bool is_locked(const RobotDescription& description, const std::string& joint) {
  return std::ranges::find(description.locked_joints, joint) != description.locked_joints.end();
}

void lock_joints(RobotDescription& description, PinocchioModel& pin) {
  const std::vector<std::string> joints = moving_joints(pin.model);
  Eigen::VectorXd q = pinocchio::neutral(pin.model);
  std::set<pinocchio::JointIndex> locked;
  for (const std::string& name : pin.urdf.mimics) {
    if (!is_locked(description, name)) description.locked_joints.push_back(name);
  }
  for (const std::string& name : description.locked_joints) {
    if (std::ranges::find(joints, name) == joints.end()) {
      throw DescriptionError(
          "locked_joints", fmt::format("robot '{}': '{}' is not a moving joint of {}{}", description.name, shown(name),
                                       description.urdf.string(), did_you_mean(name, joints)));
    }
    const pinocchio::JointIndex joint = pin.model.getJointId(name);
    locked.insert(joint);
    const auto nominal = description.nominal_joints.find(name);
    if (nominal == description.nominal_joints.end()) continue;
    Eigen::VectorXd turn = Eigen::VectorXd::Zero(pin.model.nv);
    turn(pin.model.joints[joint].idx_v()) = nominal->second;
    q = pinocchio::integrate(pin.model, q, turn);
  }
  if (locked.empty()) return;
  pinocchio::Model reduced = pinocchio::buildReducedModel(pin.model, {locked.begin(), locked.end()}, q);
  for (const pinocchio::JointIndex joint : locked) {  // Pinocchio makes their frames parents of themselves
    const std::string& name = pin.model.names[joint];
    const pinocchio::Frame& parent =
        pin.model.frames[pin.model.frames[pin.model.getFrameId(name, pinocchio::JOINT)].parentFrame];
    reduced.frames[reduced.getFrameId(name, pinocchio::FIXED_JOINT)].parentFrame =
        reduced.getFrameId(parent.name, parent.type);
  }
  pin.model = std::move(reduced);
}

std::vector<std::string> find_massless_joints(const pinocchio::Model& model) {
  pinocchio::Data data(model);
  Eigen::MatrixXd M = pinocchio::crba(model, data, pinocchio::neutral(model), pinocchio::Convention::WORLD);
  M.triangularView<Eigen::StrictlyLower>() = M.transpose();
  const Eigen::VectorXd diagonal = M.diagonal();
  std::vector<Eigen::Index> left(static_cast<std::size_t>(M.rows()));
  std::iota(left.begin(), left.end(), 0);
  std::vector<std::string> massless;
  const auto name_of = [&](Eigen::Index row) {
    return model.names[static_cast<std::size_t>(row - 6) + kBaseJoint + 1];
  };
  std::erase_if(left, [&](Eigen::Index row) {
    if (row < 6 || diagonal(row) > 0.0) return false;
    massless.push_back(name_of(row));
    return true;
  });
  while (true) {
    const Eigen::VectorXd scale = diagonal(left).cwiseSqrt().cwiseInverse();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> shapes(scale.asDiagonal() * M(left, left) *
                                                                scale.asDiagonal());
    if (!(shapes.eigenvalues()(0) < kLeastInertia)) return massless;
    const Eigen::VectorXd share = shapes.eigenvectors().col(0).cwiseAbs();
    Eigen::Index last = share.size() - 1;
    while (last > 0 && share(last) < 0.5 * share.maxCoeff()) --last;
    if (left[static_cast<std::size_t>(last)] < 6) return massless;  // the base: check_bodies() refuses it
    massless.push_back(name_of(left[static_cast<std::size_t>(last)]));
    left.erase(left.begin() + last);
  }
}

}  // namespace prowl

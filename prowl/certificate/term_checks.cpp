#include "prowl/certificate/term_checks.hpp"

#include <algorithm>
#include <cmath>
#include <pinocchio/algorithm/kinematics.hpp>
#include <utility>

#include "prowl/certificate/worst_case.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;
using Kind = Quantity::Kind;

}  // namespace

struct TermChecks::Workspace {
  struct Check {
    const TermUse& use;
    std::vector<RobotFrame> frames;  ///< of its quantities; the base where one has none
    std::vector<int> contacts;       ///< likewise; -1 where one has none
    WorstCase worst;
  };

  const DiscreteProblem& discrete;
  const MotionProblem& problem;
  const pinocchio::Model& model;
  pinocchio::Data data;
  std::vector<Check> checks;

  /// Placement and motion of a body: index into BodyTree::bodies.
  const pinocchio::SE3& placement(int body) const { return data.oMi[kBaseJoint + static_cast<std::size_t>(body)]; }
  Vector3d angular_velocity(int body) const {
    return placement(body).rotation() * data.v[kBaseJoint + static_cast<std::size_t>(body)].angular();
  }
  Vector3d velocity(int body, const Vector3d& in_body) const {
    const pinocchio::Motion& motion = data.v[kBaseJoint + static_cast<std::size_t>(body)];
    return placement(body).rotation() * (motion.linear() + motion.angular().cross(in_body));
  }

  /// Of the bodies about the centre of mass c: their own, by rotational inertia, and that of their masses.
  Vector3d angular_momentum() const {
    const Vector3d c = center_of_mass(false);
    Vector3d sum = Vector3d::Zero();
    for (pinocchio::JointIndex joint = kBaseJoint; joint < model.joints.size(); ++joint) {
      const pinocchio::Inertia& inertia = model.inertias[joint];
      const int body = static_cast<int>(joint - kBaseJoint);
      sum += placement(body).rotation() * (inertia.inertia() * data.v[joint].angular());
      sum += inertia.mass() * (placement(body).act(inertia.lever()) - c).cross(velocity(body, inertia.lever()));
    }
    return sum;
  }

  Vector3d center_of_mass(bool is_rate) const {
    Vector3d sum = Vector3d::Zero();
    for (pinocchio::JointIndex joint = kBaseJoint; joint < model.joints.size(); ++joint) {
      const int body = static_cast<int>(joint - kBaseJoint);
      const Vector3d& in_body = model.inertias[joint].lever();
      sum += model.inertias[joint].mass() * (is_rate ? velocity(body, in_body) : placement(body).act(in_body));
    }
    return sum / problem.robot.mass();
  }

  VectorXd quantity(const TrajectoryPoint& point, const VectorXd& force, Kind kind, const RobotFrame& frame,
                    int contact) const {
    switch (kind) {
      case Kind::position: return placement(frame.body).act(Vector3d(frame.placement.translation()));
      case Kind::orientation: return Matrix3d(placement(frame.body).rotation() * frame.placement.linear()).reshaped();
      case Kind::velocity: return velocity(frame.body, frame.placement.translation());
      case Kind::orientation_rate: {
        const Matrix3d axes = placement(frame.body).rotation() * frame.placement.linear();
        return Matrix3d(so3::skew(angular_velocity(frame.body)) * axes).reshaped();
      }
      case Kind::center_of_mass: return center_of_mass(false);
      case Kind::center_of_mass_velocity: return center_of_mass(true);
      case Kind::angular_momentum: return angular_momentum();
      case Kind::joints: return point.q.tail(problem.robot.nu());
      case Kind::joint_rates: return point.v.tail(problem.robot.nu());
      case Kind::torques: return point.tau;
      case Kind::force: return force.segment<3>(3 * contact);
      case Kind::time: return VectorXd::Constant(1, point.time);
    }
    return {};
  }

  void record(const TrajectoryPoint& point, const VectorXd& force, Check& check) {
    const std::vector<Quantity>& reads = check.use.term->reads();
    VectorXd y(size_of(reads, problem.robot)), f(check.use.term->num_rows());
    Eigen::Index first = 0;
    for (std::size_t i = 0; i < reads.size(); ++i) {
      const VectorXd entries = quantity(point, force, reads[i].kind, check.frames[i], check.contacts[i]);
      y.segment(first, entries.size()) = entries;
      first += entries.size();
    }
    f.setZero();
    check.use.term->value(y, f);
    for (Eigen::Index row = 0; row < f.size(); ++row) {
      const double lower = check.use.lower(row), upper = check.use.upper(row);
      if (std::isinf(lower) && std::isinf(upper)) continue;
      check.worst.record(std::max(lower - f(row), f(row) - upper), point.time, check.use.term->rows()[row]);
    }
  }
};

TermChecks::TermChecks(const DiscreteProblem& discrete) {
  const MotionProblem& problem = discrete.problem;
  if (problem.terms.empty()) return;
  const pinocchio::Model& model = problem.robot.pinocchio().model;
  workspace_.reset(new Workspace{discrete, problem, model, pinocchio::Data(model), {}});
  for (const TermUse& use : problem.terms) {
    if (use.is_cost()) continue;
    std::vector<RobotFrame> frames;
    std::vector<int> contacts;
    for (const Quantity& quantity : use.term->reads()) {
      frames.push_back(is_of_frame(quantity.kind) ? robot_frame(problem.robot, quantity.name) : RobotFrame());
      contacts.push_back(quantity.kind == Kind::force ? problem.robot.contact_index(quantity.name) : -1);
    }
    workspace_->checks.push_back(
        {use, std::move(frames), std::move(contacts),
         WorstCase(kTermCheck + use.name + "'", use.term->unit(), term_tolerance(problem, *use.term))});
  }
}

TermChecks::~TermChecks() = default;

void TermChecks::record(const TrajectoryPoint& point, const VectorXd& force, int left, int node) {
  if (!workspace_) return;
  const DiscreteProblem& discrete = workspace_->discrete;
  pinocchio::forwardKinematics(workspace_->model, workspace_->data, point.q, point.v);
  for (Workspace::Check& check : workspace_->checks) {
    const auto holds = [&](int k) {  // not by its time, which files round
      return discrete.holds(check.use, discrete.nodes[k].phase, discrete.nodes[k].node);
    };
    const bool counts = check.use.is_moment() ? node >= 0 && holds(node) : holds(left) && holds(left + 1);
    if (counts) workspace_->record(point, force, check);
  }
}

void TermChecks::append_to(std::vector<CertificateCheck>& checks) const {
  if (!workspace_) return;
  for (const Workspace::Check& check : workspace_->checks) check.worst.append_to(checks);
}

}  // namespace prowl

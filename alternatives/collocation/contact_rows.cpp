#include "alternatives/collocation/contact_rows.hpp"

#include <cmath>

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ContactRows::ContactRows(const MotionProblem& problem, int phase, Kinds kinds)
    : kinds_(kinds),
      length_(problem.robot.size()),
      speed_(std::sqrt(RobotModel::kGravity * length_)),
      acceleration_(RobotModel::kGravity),
      kinematics_(contact_indices(problem.phases[phase].contacts)),
      at_rest_(VectorXd::Zero(problem.robot.nv())),
      hessian_(problem.robot.nv()) {
  for (const PhaseContact& held : problem.phases[phase].contacts) {
    const Surface& surface = problem.surfaces[held.surface];
    const ContactPoint& contact = problem.robot.contacts()[held.contact];
    names_.push_back(contact.name);
    normals_.push_back(surface.normal);
    offsets_.push_back(surface.normal.dot(surface.point) + contact.radius);
  }
}

std::string ContactRows::describe(int row) const {
  if (row < distances()) return names_[row] + ", distance to its surface";
  row -= distances();
  const bool velocity = row < velocities();
  if (!velocity) row -= velocities();
  return names_[row / 3] + (velocity ? ", velocity " : ", acceleration ") + "xyz"[row % 3];
}

void ContactRows::evaluate(const RigidBodyTerms& terms, const DynamicsPoint& at, Eigen::Ref<VectorXd> values) {
  if (count() == 0) return;
  kinematics_.set_configuration(terms);
  const VectorXd& p = kinematics_.positions();
  for (int i = 0; i < distances(); ++i) {
    values(i) = (normals_[i].dot(p.segment<3>(3 * i)) - offsets_[i]) / length_;
  }
  if (velocities() > 0) values.segment(distances(), velocities()) = kinematics_.jacobian() * at.v / speed_;
  if (accelerations() > 0) {
    kinematics_.set_motion(at.v, at.a + at.stabilisation.kd * at.v);
    values.tail(accelerations()) =
        (kinematics_.acceleration() + at.stabilisation.kp * (p - at.anchors)) / acceleration_;
  }
}

void ContactRows::derivatives(const DynamicsPoint& at, Derivatives& result) {
  const Index nv = at.v.size(), rows = count();
  result.q.setZero(rows, nv);
  result.v.setZero(rows, nv);
  result.a.setZero(rows, nv);
  result.anchors.setZero(rows, kinematics_.rows());
  result.gains.setZero(rows, 2);
  if (rows == 0) return;
  const MatrixXd& J = kinematics_.jacobian();
  for (int i = 0; i < distances(); ++i) {
    result.q.row(i) = normals_[i].transpose() * kinematics_.positions_dq().middleRows<3>(3 * i) / length_;
  }
  MatrixXd slope;
  if (velocities() > 0) {
    kinematics_.set_motion(at_rest_, at.v);
    kinematics_.acceleration_dq(slope);
    result.q.middleRows(distances(), velocities()) = slope / speed_;
    result.v.middleRows(distances(), velocities()) = J / speed_;
  }
  if (accelerations() == 0) return;
  const auto [kd, kp] = at.stabilisation;
  kinematics_.set_motion(at.v, at.a + kd * at.v);
  kinematics_.acceleration_dq(slope);
  result.q.bottomRows(accelerations()) = (slope + kp * kinematics_.positions_dq()) / acceleration_;
  kinematics_.acceleration_dv(slope);
  result.v.bottomRows(accelerations()) = (slope + kd * J) / acceleration_;
  result.a.bottomRows(accelerations()) = J / acceleration_;
  result.anchors.bottomRows(accelerations()).diagonal().setConstant(-kp / acceleration_);
  result.gains.bottomRows(accelerations()) << J * at.v / acceleration_,
      (kinematics_.positions() - at.anchors) / acceleration_;
}

const ContactRows::Hessian& ContactRows::hessian(const DynamicsPoint& at, const VectorXd& multipliers) {
  Hessian& h = hessian_;
  const Index nv = at.v.size();
  h.set_zero();
  h.qgains.setZero(nv, 2);
  h.vgains.setZero(nv, 2);
  h.de.setZero(kinematics_.rows());
  if (count() == 0) return h;
  if (distances() > 0) {
    VectorXd on_position(kinematics_.rows());
    for (int i = 0; i < distances(); ++i) {
      on_position.segment<3>(3 * i) = multipliers(i) / length_ * normals_[i];
    }
    kinematics_.add_position_hessian(on_position, 1.0, h.qq);
  }
  if (velocities() > 0) {  // J v is the acceleration of a = v at rest
    SecondDerivatives at_rest(static_cast<int>(nv));
    at_rest.set_zero();
    kinematics_.set_motion(at_rest_, at.v);
    kinematics_.add_acceleration_hessian(multipliers.segment(distances(), velocities()) / speed_, 0.0, at_rest);
    h.qq += at_rest.qq;
    h.qv += at_rest.qa;
  }
  if (accelerations() == 0) return h;
  const auto [kd, kp] = at.stabilisation;
  h.de = multipliers.tail(accelerations()) / acceleration_;
  kinematics_.set_motion(at_rest_, at.v);
  MatrixXd slope;
  kinematics_.acceleration_dq(slope);
  h.qgains.col(0) = slope.transpose() * h.de;
  h.qgains.col(1) = kinematics_.positions_dq().transpose() * h.de;
  h.vgains.col(0) = kinematics_.jacobian().transpose() * h.de;
  kinematics_.set_motion(at.v, at.a + kd * at.v);
  kinematics_.add_acceleration_hessian(h.de, kd, h);
  kinematics_.add_position_hessian(h.de, kp, h.qq);
  return h;
}

}  // namespace prowl

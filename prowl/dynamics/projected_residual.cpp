#include "prowl/dynamics/projected_residual.hpp"

#include "prowl/error.hpp"

namespace prowl {

ProjectedResidual::ProjectedResidual(const RobotModel& robot, std::vector<int> contacts)
    : mass_(robot.mass()),
      terms_(robot),
      kinematics_(std::move(contacts)),
      second_(robot.nv()),
      kinematic_second_(robot.nv()) {}

void ProjectedResidual::compute_forces(const DynamicsPoint& point) {
  const auto nu = point.tau.size();
  kinematics_.set_configuration(terms_);
  kinematics_.set_motion(point.v, point.a + point.stabilisation.kd * point.v);
  projector_.compute(kinematics_.jacobian());

  r_ = terms_.inverse_dynamics();
  r_.tail(nu) -= point.tau;
  e_ = kinematics_.acceleration() + point.stabilisation.kp * (kinematics_.positions() - point.anchors);
  f_ = projector_.gram_inverse() * (kinematics_.jacobian() * r_ - mass_ * e_);
  c_ = r_ - kinematics_.jacobian().transpose() * f_;
  if (!c_.allFinite() || !f_.allFinite()) {
    throw NumericalError("the projected dynamics are not finite here: a state, torque or inertia is NaN or too large");
  }
}

void ProjectedResidual::evaluate(const DynamicsPoint& point) {
  terms_.update(point.q, point.v, point.a);
  compute_forces(point);
}

void ProjectedResidual::evaluate_with_derivatives(const DynamicsPoint& point) {
  terms_.update_with_derivatives(point.q, point.v, point.a);
  compute_forces(point);

  const Eigen::MatrixXd& J = kinematics_.jacobian();
  const Eigen::MatrixXd& W = projector_.gram_inverse();
  const double kd = point.stabilisation.kd, kp = point.stabilisation.kp;
  const auto nu = point.tau.size();

  // A: derivatives of the equations of motion with the contact force held fixed in the world.
  dc_.q = terms_.dq();
  work_n_.setZero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(f_, work_n_);
  dc_.q -= work_n_;
  dc_.v = terms_.dv();
  dc_.a = terms_.mass_matrix();
  dc_.tau.setZero(terms_.nv(), nu);
  dc_.tau.bottomRows(nu).diagonal().setConstant(-1.0);

  // J c = s J J⁺ e: differentiate, solve for df = (J J')⁺ (J A + dJ c - s de). Both dJ c and s de come from one chain
  // pass, since the acceleration is linear in its second argument.
  kinematics_.set_motion(point.v, point.a + kd * point.v - c_ / mass_);
  kinematics_.acceleration_dq(work_m_);
  df_.q = J * dc_.q - mass_ * (work_m_ + kp * kinematics_.positions_dq());
  kinematics_.acceleration_dv(work_m_);
  df_.v = J * dc_.v - mass_ * (work_m_ + kd * J);
  df_.a = J * dc_.a - mass_ * J;
  df_.tau = -J.rightCols(nu);
  for (Eigen::MatrixXd* y : {&df_.q, &df_.v, &df_.a, &df_.tau}) *y = W * *y;

  dc_.q -= J.transpose() * df_.q;
  dc_.v -= J.transpose() * df_.v;
  dc_.a -= J.transpose() * df_.a;
  dc_.tau -= J.transpose() * df_.tau;
  if (has_full_rank()) return;

  // Redundant contacts: the part of e that no motion can remove turns with J, and so does the choice of f.
  const Eigen::VectorXd e_lost = e_ - J * (J.transpose() * (W * e_));
  work_n_.setZero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(e_lost, work_n_);
  const Eigen::MatrixXd turned = mass_ * (W * (J * work_n_));  // s J⁺' E with E = d(J' e_lost)
  dc_.q += J.transpose() * (W * turned);
  df_.q -= W * turned;
  kinematics_.set_motion(Eigen::VectorXd::Zero(terms_.nv()), J.transpose() * (W * f_));
  kinematics_.acceleration_dq(work_m_);
  df_.q += work_m_ - J * (J.transpose() * (W * work_m_));
}

const PointHessian& ProjectedResidual::hessian(const DynamicsPoint& point, const Eigen::VectorXd& mu,
                                               const Eigen::VectorXd& nu) {
  if (!has_full_rank()) {
    throw NumericalError("the second derivatives of the projected dynamics need independent contacts");
  }
  const Eigen::MatrixXd& J = kinematics_.jacobian();
  const double kd = point.stabilisation.kd, kp = point.stabilisation.kp;

  // (c, f) solve  c + J' f = r,  J c = s e.  With the adjoint (l1, l2) of that system,
  //   d2(mu.c + nu.f) = l1.d2r + s l2.d2e - f.d2J l1 - l2.d2J c - 2 df.dJ l1 - 2 l2.dJ dc.
  const Eigen::VectorXd l2 = projector_.gram_inverse() * (J * mu - nu);
  const Eigen::VectorXd l1 = mu - J.transpose() * l2;

  second_.set_zero();
  terms_.add_second_derivatives(point.q, point.v, point.a, l1, second_);

  kinematic_second_.set_zero();
  kinematics_.set_motion(point.v, point.a + kd * point.v - c_ / mass_);
  kinematics_.add_acceleration_hessian(l2, kinematic_second_);
  hessian_.qq = second_.qq + mass_ * kinematic_second_.qq;
  hessian_.qv = second_.qv + mass_ * (kinematic_second_.qv + kd * kinematic_second_.qa);
  hessian_.qa = second_.qa + mass_ * kinematic_second_.qa;
  hessian_.vv = second_.vv + mass_ * kinematic_second_.vv;
  kinematics_.add_position_hessian(l2, mass_ * kp, hessian_.qq);

  kinematic_second_.set_zero();
  kinematics_.set_motion(Eigen::VectorXd::Zero(terms_.nv()), l1);
  kinematics_.add_acceleration_hessian(f_, kinematic_second_);
  hessian_.qq -= kinematic_second_.qq;

  kinematics_.acceleration_dq(work_m_);  // d(J l1)/dq
  work_n_.setZero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(l2, work_n_);  // d(J' l2)/dq
  const Eigen::MatrixXd cross = work_m_.transpose() * df_.q + work_n_.transpose() * dc_.q;
  hessian_.qq -= cross + cross.transpose();
  hessian_.qv -= work_m_.transpose() * df_.v + work_n_.transpose() * dc_.v;
  hessian_.qa -= work_m_.transpose() * df_.a + work_n_.transpose() * dc_.a;
  hessian_.qtau = -(work_m_.transpose() * df_.tau + work_n_.transpose() * dc_.tau);
  return hessian_;
}

}  // namespace prowl

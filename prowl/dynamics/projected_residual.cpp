#include "prowl/dynamics/projected_residual.hpp"

#include <algorithm>

#include "prowl/error.hpp"

namespace prowl {

namespace {

/// s as a part of the robot's mass. Away from c = 0 the forces that are recovered are those of springs of stiffness s kp: at s = mass
/// and a step of 10 ms 1 mm off a contact's place is the weight of the robot, and cones and forces that have to vanish are bent by
/// it (HyQ trot, 125 intervals: 66 + 54 iterations, with this 18 + 31; 0.1 and 0.001 do as well). It also
/// says how well e vanishes where rows hold to a tolerance: at 1e-6 of the weight to about 1e-3 m/s^2.
constexpr double kContactWeight = 0.01;

}  // namespace

ProjectedResidual::ProjectedResidual(const RobotModel& robot, std::vector<int> contacts, std::vector<int> chosen_rows)
    : contact_weight_(kContactWeight * robot.mass()),
      terms_(robot),
      kinematics_(std::move(contacts)),
      chosen_rows_(std::move(chosen_rows)),
      second_(robot.nv()),
      kinematic_second_(robot.nv()) {
  for (int row = 0; row < kinematics_.rows(); ++row) {
    if (std::ranges::find(chosen_rows_, row) == chosen_rows_.end()) kept_rows_.push_back(row);
  }
}

void ProjectedResidual::compute_gram_inverse() {
  if (chosen_rows_.empty()) {
    projector_.compute(kinematics_.jacobian());
    gram_inverse_ = projector_.gram_inverse();
    return;
  }
  kept_ = kinematics_.jacobian()(kept_rows_, Eigen::all);
  projector_.compute(kept_);
  gram_inverse_.setZero(kinematics_.rows(), kinematics_.rows());
  gram_inverse_(kept_rows_, kept_rows_) = projector_.gram_inverse();
}

void ProjectedResidual::compute_forces(const DynamicsPoint& point) {
  const auto nu = point.tau.size();
  kinematics_.set_configuration(terms_);
  kinematics_.set_motion(point.v, point.a + point.stabilisation.kd * point.v);
  compute_gram_inverse();

  r_ = terms_.inverse_dynamics();
  r_.tail(nu) -= point.tau;
  for (std::size_t i = 0; i < chosen_rows_.size(); ++i) {
    r_ -= point.chosen_forces(static_cast<Eigen::Index>(i)) * kinematics_.jacobian().row(chosen_rows_[i]).transpose();
  }
  e_ = kinematics_.acceleration() + point.stabilisation.kp * (kinematics_.positions() - point.anchors);
  f_ = gram_inverse_ * (kinematics_.jacobian() * r_ - contact_weight_ * e_);
  c_ = r_ - kinematics_.jacobian().transpose() * f_;
  for (std::size_t i = 0; i < chosen_rows_.size(); ++i) {
    f_(chosen_rows_[i]) = point.chosen_forces(static_cast<Eigen::Index>(i));
  }
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
  const Eigen::MatrixXd& W = gram_inverse_;
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
  kinematics_.set_motion(point.v, point.a + kd * point.v - c_ / contact_weight_);
  kinematics_.acceleration_dq(work_m_);
  df_.q = J * dc_.q - contact_weight_ * (work_m_ + kp * kinematics_.positions_dq());
  kinematics_.acceleration_dv(work_m_);
  df_.v = J * dc_.v - contact_weight_ * (work_m_ + kd * J);
  df_.a = J * dc_.a - contact_weight_ * J;
  df_.tau = -J.rightCols(nu);
  dc_.w = -J(chosen_rows_, Eigen::all).transpose();
  df_.w = J * dc_.w;
  dc_.e.setZero(terms_.nv(), J.rows());
  for (Eigen::MatrixXd* y : {&df_.q, &df_.v, &df_.a, &df_.tau, &df_.w}) *y = W * *y;
  df_.e = -contact_weight_ * W;

  dc_.q -= J.transpose() * df_.q;
  dc_.v -= J.transpose() * df_.v;
  dc_.a -= J.transpose() * df_.a;
  dc_.tau -= J.transpose() * df_.tau;
  dc_.w -= J.transpose() * df_.w;
  dc_.e -= J.transpose() * df_.e;
  Eigen::MatrixXd e_gains(J.rows(), 2);
  e_gains << J * point.v, kinematics_.positions() - point.anchors;
  dc_.gains = dc_.e * e_gains;
  df_.gains = df_.e * e_gains;
  for (std::size_t i = 0; i < chosen_rows_.size(); ++i) df_.w(chosen_rows_[i], static_cast<Eigen::Index>(i)) = 1.0;
  if (has_full_rank()) return;

  // Redundant contacts: the part of e that no motion can remove turns with J, and so does the choice of f.
  const Eigen::VectorXd e_lost = e_ - J * (J.transpose() * (W * e_));
  work_n_.setZero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(e_lost, work_n_);
  const Eigen::MatrixXd turned = contact_weight_ * (W * (J * work_n_));  // s J⁺' E with E = d(J' e_lost)
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
  // A chosen row has no part in either sum but its force, w in r: l2 is zero there.
  const Eigen::VectorXd l2 = gram_inverse_ * (J * mu - nu);
  const Eigen::VectorXd l1 = mu - J.transpose() * l2;

  second_.set_zero();
  terms_.add_second_derivatives(point.q, point.v, point.a, l1, second_);

  kinematic_second_.set_zero();
  kinematics_.set_motion(point.v, point.a + kd * point.v - c_ / contact_weight_);
  kinematics_.add_acceleration_hessian(l2, kinematic_second_);
  hessian_.qq = second_.qq + contact_weight_ * kinematic_second_.qq;
  hessian_.qv = second_.qv + contact_weight_ * (kinematic_second_.qv + kd * kinematic_second_.qa);
  hessian_.qa = second_.qa + contact_weight_ * kinematic_second_.qa;
  hessian_.vv = second_.vv + contact_weight_ * kinematic_second_.vv;
  kinematics_.add_position_hessian(l2, contact_weight_ * kp, hessian_.qq);

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
  hessian_.qw = -(work_m_.transpose() * df_.w + work_n_.transpose() * dc_.w);
  hessian_.qe = -(work_m_.transpose() * df_.e + work_n_.transpose() * dc_.e);

  hessian_.de = contact_weight_ * l2;
  hessian_.qgains = -(work_m_.transpose() * df_.gains + work_n_.transpose() * dc_.gains);
  kinematics_.set_motion(Eigen::VectorXd::Zero(terms_.nv()), point.v);
  kinematics_.acceleration_dq(work_m_);  // d(J v)/dq
  hessian_.qgains.col(0) += work_m_.transpose() * hessian_.de;
  hessian_.qgains.col(1) += kinematics_.positions_dq().transpose() * hessian_.de;
  hessian_.vgains.setZero(terms_.nv(), 2);
  hessian_.vgains.col(0) = J.transpose() * hessian_.de;
  return hessian_;
}

}  // namespace prowl

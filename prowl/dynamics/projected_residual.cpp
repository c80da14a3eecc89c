#include "prowl/dynamics/projected_residual.hpp"

#include <algorithm>

#include "prowl/error.hpp"

namespace prowl {

namespace {

/// s as a part of the robot's mass. Away from c = 0 the recovered forces contain springs of stiffness s kp. At s = mass
/// and a step of 10 ms, 1 mm off an anchor gives the weight of the robot, which distorts friction cones (HyQ trot, 125
/// intervals: 66 + 54 iterations; with this value 18 + 31; 0.1 and 0.001 do as well). s also sets how well e vanishes:
/// rows that hold to 1e-6 of the weight leave about 1e-3 m/s².
constexpr double kContactWeight = 0.01;

}  // namespace

ProjectedResidual::ProjectedResidual(const RobotModel& robot, std::vector<int> contacts, std::vector<int> chosen_rows)
    : contact_weight_(kContactWeight * robot.mass()),
      terms_(robot),
      kinematics_(std::move(contacts)),
      chosen_rows_(std::move(chosen_rows)),
      hessian_(robot.nv()),
      zero_(Eigen::VectorXd::Zero(robot.nv())) {
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
  const auto kept = static_cast<Eigen::Index>(kept_rows_.size());
  kept_.resize(kept, terms_.nv());
  const auto row = [this](Eigen::Index i) { return kept_rows_[i]; };
  for (Eigen::Index i = 0; i < kept; ++i) kept_.row(i) = kinematics_.jacobian().row(row(i));
  projector_.compute(kept_);
  gram_inverse_.setZero(kinematics_.rows(), kinematics_.rows());
  for (Eigen::Index i = 0; i < kept; ++i) {
    for (Eigen::Index j = 0; j < kept; ++j) gram_inverse_(row(i), row(j)) = projector_.gram_inverse()(i, j);
  }
}

void ProjectedResidual::compute_forces(const DynamicsPoint& point) {
  const auto nu = point.tau.size();
  kinematics_.set_configuration(terms_);
  work_v_ = point.a + point.stabilisation.kd * point.v;
  kinematics_.set_motion(point.v, work_v_);
  compute_gram_inverse();

  const Eigen::MatrixXd& J = kinematics_.jacobian();
  r_ = terms_.inverse_dynamics();
  r_.tail(nu) -= point.tau;
  for (std::size_t i = 0; i < chosen_rows_.size(); ++i) {
    r_ -= point.chosen_forces(static_cast<Eigen::Index>(i)) * J.row(chosen_rows_[i]).transpose();
  }
  e_ = kinematics_.acceleration() + point.stabilisation.kp * (kinematics_.positions() - point.anchors);
  Jt_ = J.transpose();
  work_f_ = -contact_weight_ * e_;
  kernels_.add(work_f_, J, r_);
  f_.resize(J.rows());
  kernels_.set(f_, gram_inverse_, work_f_);
  c_ = r_;
  kernels_.add(c_, Jt_, f_, -1.0);
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

  // A: derivatives of the equations of motion with the contact force held fixed in the world. A_v and A_a are dv() and
  // the mass matrix, A_tau = -S', A_w = -(chosen rows of J)', A_e = 0.
  work_f_ = -f_;
  A_q_ = terms_.dq();
  kinematics_.add_force_derivative(work_f_, A_q_);
  K_.resize(J.rows(), J.cols());
  kernels_.set(K_, W, J);

  // J c = s J J⁺ e: differentiate, solve for df = (J J')⁺ (J A + dJ c - s de). Both dJ c and s de come from one chain
  // pass, since the acceleration is linear in its second argument.
  work_v_ = point.a + kd * point.v - c_ / contact_weight_;
  kinematics_.set_motion(point.v, work_v_);
  kinematics_.acceleration_dq(work_m_);
  rhs_ = -contact_weight_ * (work_m_ + kp * kinematics_.positions_dq());
  kernels_.add(rhs_, J, A_q_);
  df_.q.resizeLike(rhs_);
  kernels_.set(df_.q, W, rhs_);
  kinematics_.acceleration_dv(work_m_);
  rhs_ = -contact_weight_ * (work_m_ + kd * J);
  kernels_.add(rhs_, J, terms_.dv());
  df_.v.resizeLike(rhs_);
  kernels_.set(df_.v, W, rhs_);
  df_.a = -contact_weight_ * K_;
  kernels_.add(df_.a, K_, terms_.mass_matrix());
  df_.tau = -K_.rightCols(nu);
  df_.e = -contact_weight_ * W;

  // dc = A - J' df
  dc_.q = A_q_;
  kernels_.add(dc_.q, Jt_, df_.q, -1.0);
  dc_.v = terms_.dv();
  kernels_.add(dc_.v, Jt_, df_.v, -1.0);
  dc_.a = terms_.mass_matrix();
  kernels_.add(dc_.a, Jt_, df_.a, -1.0);
  dc_.tau.setZero(terms_.nv(), nu);
  dc_.tau.bottomRows(nu).diagonal().setConstant(-1.0);
  kernels_.add(dc_.tau, Jt_, df_.tau, -1.0);
  dc_.e = contact_weight_ * K_.transpose();

  const auto chosen = static_cast<Eigen::Index>(chosen_rows_.size());
  dc_.w.resize(terms_.nv(), chosen);
  for (Eigen::Index i = 0; i < chosen; ++i) dc_.w.col(i) = -J.row(chosen_rows_[i]);
  df_.w.resize(J.rows(), chosen);
  kernels_.set(df_.w, K_, dc_.w);
  kernels_.add(dc_.w, Jt_, df_.w, -1.0);
  for (Eigen::Index i = 0; i < chosen; ++i) df_.w(chosen_rows_[i], i) = 1.0;

  e_gains_.resize(J.rows(), 2);
  e_gains_.col(0).noalias() = J * point.v;
  e_gains_.col(1) = kinematics_.positions() - point.anchors;
  dc_.gains.noalias() = dc_.e * e_gains_;
  df_.gains.noalias() = df_.e * e_gains_;
  if (!has_full_rank()) add_redundancy();
}

// Redundant contacts: the part of e that no motion can remove turns with J, and so does the choice of f.
void ProjectedResidual::add_redundancy() {
  const Eigen::MatrixXd& J = kinematics_.jacobian();
  const Eigen::MatrixXd& W = gram_inverse_;
  const Eigen::VectorXd e_lost = e_ - J * (J.transpose() * (W * e_));
  work_n_.setZero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(e_lost, work_n_);
  const Eigen::MatrixXd turned = contact_weight_ * (W * (J * work_n_));  // s J⁺' E with E = d(J' e_lost)
  dc_.q += J.transpose() * (W * turned);
  df_.q -= W * turned;
  kinematics_.set_motion(zero_, J.transpose() * (W * f_));
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
  PointHessian& h = hessian_;

  // (c, f) solve  c + J' f = r,  J c = s e.  With the adjoint (l1, l2) of that system,
  //   d2(mu.c + nu.f) = l1.d2r + s l2.d2e - f.d2J l1 - l2.d2J c - 2 df.dJ l1 - 2 l2.dJ dc.
  // A chosen row enters only by its force w in r: l2 is zero there.
  work_f_ = -nu;
  kernels_.add(work_f_, J, mu);
  l2_.resize(J.rows());
  kernels_.set(l2_, gram_inverse_, work_f_);
  l1_ = mu;
  kernels_.add(l1_, Jt_, l2_, -1.0);
  h.de = contact_weight_ * l2_;

  h.set_zero();
  terms_.add_second_derivatives(l1_, h);
  work_v_ = point.a + kd * point.v - c_ / contact_weight_;
  kinematics_.set_motion(point.v, work_v_);
  kinematics_.add_acceleration_hessian(h.de, kd, h);
  kinematics_.add_position_hessian(h.de, kp, h.qq);
  kinematics_.set_motion(zero_, l1_);
  work_f_ = -f_;
  kinematics_.add_acceleration_hessian_qq(work_f_, h.qq);

  // df.dJ l1 + l2.dJ dc with dc = A - J' df and N = d(J' l2)/dq:  G' df + N' A,  G = d(J l1)/dq - J N. The first three
  // columns of G and N, for the base position, are zero.
  kinematics_.acceleration_dq(work_m_);  // d(J l1)/dq
  work_n_.setZero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(l2_, work_n_);
  kernels_.add(work_m_, J, work_n_, -1.0);
  const Eigen::Index turning = terms_.nv() - 3, joints = point.tau.size();
  Gt_ = work_m_.rightCols(turning).transpose();
  Nt_ = work_n_.rightCols(turning).transpose();
  cross_.resize(turning, terms_.nv());
  kernels_.set(cross_, Gt_, df_.q);
  kernels_.add(cross_, Nt_, A_q_);
  h.qq.bottomRows(turning) -= cross_;
  h.qq.rightCols(turning) -= cross_.transpose();
  auto qv = h.qv.bottomRows(turning);
  kernels_.add(qv, Gt_, df_.v, -1.0);
  kernels_.add(qv, Nt_, terms_.dv(), -1.0);
  auto qa = h.qa.bottomRows(turning);
  kernels_.add(qa, Gt_, df_.a, -1.0);
  kernels_.add(qa, Nt_, terms_.mass_matrix(), -1.0);
  h.qtau.resize(terms_.nv(), joints);
  h.qtau.topRows(3).setZero();
  h.qtau.bottomRows(turning) = Nt_.rightCols(joints);
  kernels_.add(h.qtau.bottomRows(turning), Gt_, df_.tau, -1.0);
  h.qe.resize(terms_.nv(), J.rows());
  h.qe.topRows(3).setZero();
  kernels_.set(h.qe.bottomRows(turning), Gt_, df_.e, -1.0);
  h.qw.resize(terms_.nv(), df_.w.cols());  // A_w = -J' of the chosen rows, whose own 1 in df adds J' again
  h.qw.topRows(3).setZero();
  kernels_.set(h.qw.bottomRows(turning), Gt_, df_.w, -1.0);

  h.qgains.noalias() = h.qe * e_gains_;
  h.qgains.col(0).noalias() += contact_weight_ * (work_n_.transpose() * point.v);  // l2.d(J v)
  h.qgains.col(1).noalias() += kinematics_.positions_dq().transpose() * h.de;
  h.vgains.setZero(terms_.nv(), 2);
  h.vgains.col(0).noalias() = Jt_ * h.de;
  return h;
}

}  // namespace prowl

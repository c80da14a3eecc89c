#include "prowl/dynamics/forward_dynamics.hpp"

#include "prowl/error.hpp"

namespace prowl {

ForwardDynamics::ForwardDynamics(const RobotModel& robot, std::vector<int> contacts, double rank_threshold)
    : terms_(robot), kinematics_(std::move(contacts)), rank_threshold_(rank_threshold) {}

void ForwardDynamics::evaluate(const Eigen::VectorXd& q, const Eigen::VectorXd& v, const Eigen::VectorXd& tau) {
  zero_.setZero(terms_.nv());
  terms_.update_with_derivatives(q, v, zero_);  // for M; r0 at a = 0 is h
  kinematics_.set_configuration(terms_);
  kinematics_.set_motion(v, zero_);  // the acceleration at a = 0 is J̇ v
  projector_.compute(kinematics_.jacobian(), rank_threshold_);
  projector_.form(P_, pinv_);

  const Eigen::MatrixXd& M = terms_.mass_matrix();
  PM_.noalias() = P_ * M;
  constrained_mass_.compute(M + PM_ - PM_.transpose());

  applied_ = -terms_.inverse_dynamics();  // S' τ − h
  applied_.tail(tau.size()) += tau;
  pulled_.noalias() = pinv_ * kinematics_.acceleration();  // −C v
  driven_.noalias() = P_ * applied_;
  driven_.noalias() -= M * pulled_;
  a_ = constrained_mass_.solve(driven_);
  left_ = -applied_;
  left_.noalias() += M * a_;
  f_.noalias() = pinv_.transpose() * left_;
  if (!a_.allFinite() || !f_.allFinite()) {
    throw NumericalError("the forward dynamics are not finite here: a state, torque or inertia is NaN or too large");
  }
}

// docs/theory.md#forward-form. a and f solve
//   P (M a + h − S' τ) = 0,   J⁺ (J a + J̇ v) = 0,   f = J⁺' (M a + h − S' τ).
// With R = M a + h − S' τ − J' f at fixed a and f, and g = J a + J̇ v at fixed a, the first two give
//   P (M da + dR) = 0,   J⁺ (J da + dg) = 0   =>   Mc da = −P dR − M J⁺ dg,
// as in the forward form itself, with −dR for S' τ − h and −J⁺ dg for C v; and J' df = M da + dR.
void ForwardDynamics::evaluate_with_derivatives(const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                                                const Eigen::VectorXd& tau) {
  evaluate(q, v, tau);
  terms_.update_with_derivatives(q, v, a_);
  kinematics_.set_motion(v, a_);
  const int nv = terms_.nv();
  const auto nu = tau.size();

  Eigen::MatrixXd turned_forces = Eigen::MatrixXd::Zero(nv, nv);  // ∂(J' f)/∂q
  kinematics_.add_force_derivative(f_, turned_forces);
  const Derivatives dR{terms_.dq() - turned_forces, terms_.dv(), -Eigen::MatrixXd::Identity(nv, nv).rightCols(nu)};
  Derivatives dg{{}, {}, Eigen::MatrixXd::Zero(kinematics_.rows(), nu)};
  kinematics_.acceleration_dq(dg.q);
  kinematics_.acceleration_dv(dg.v);
  if (!projector_.full_rank()) add_turn_of_lost_acceleration(dg.q);

  const Eigen::MatrixXd& M = terms_.mass_matrix();
  for (const auto block : {&Derivatives::q, &Derivatives::v, &Derivatives::tau}) {
    da_.*block = constrained_mass_.solve(-P_ * (dR.*block) - M * (pinv_ * (dg.*block)));
    df_.*block = pinv_.transpose() * (M * (da_.*block) + dR.*block);
  }
  if (!projector_.full_rank()) add_turn_of_force_space(df_.q);
}

ForwardDynamics::Response ForwardDynamics::response(const Eigen::MatrixXd& applied) const {
  const Eigen::MatrixXd acceleration = constrained_mass_.solve(P_ * applied);
  return {acceleration, pinv_.transpose() * (terms_.mass_matrix() * acceleration - applied)};
}

// Redundant contacts leave a part e = (I − J J⁺)(J a + J̇ v) that no acceleration can remove (zero if J v = 0). It
// enters d(J⁺ e) = J⁺ (de + J⁺' dJ' e) = 0.
void ForwardDynamics::add_turn_of_lost_acceleration(Eigen::MatrixXd& dg_dq) const {
  Eigen::MatrixXd turned = Eigen::MatrixXd::Zero(terms_.nv(), terms_.nv());
  kinematics_.add_force_derivative(kinematics_.acceleration(), turned);
  dg_dq += pinv_.transpose() * turned;
}

// Among all forces with the same J' f, f is in the range of J, which turns: (I − J J⁺) df = (I − J J⁺) dJ J⁺ f.
void ForwardDynamics::add_turn_of_force_space(Eigen::MatrixXd& df_dq) {
  kinematics_.set_motion(Eigen::VectorXd::Zero(terms_.nv()), pinv_ * f_);
  Eigen::MatrixXd turned;
  kinematics_.acceleration_dq(turned);
  df_dq += turned - kinematics_.jacobian() * (pinv_ * turned);
}

}  // namespace prowl

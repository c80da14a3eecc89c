#include "prowl/transcription/node_functions.hpp"

#include <algorithm>
#include <limits>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Smoothing eps of the friction cones' tips [N]: 1 % of the weight, 8.5 N for HyQ. A sharper tip costs iterations where a foot is
/// about to lift. Each contact has to carry eps / friction, so less where friction is low or contacts are many: all
/// together no more than a fifth of the weight.
double cone_smoothing(const MotionProblem& problem, double friction, std::size_t contacts) {
  return problem.robot.weight() * std::min(0.01, 0.2 * friction / static_cast<double>(contacts));
}

constexpr const char* kBaseForce[] = {"force x", "force y", "force z", "moment x", "moment y", "moment z"};

const Phase& phase_of(const MotionProblem& problem, int phase) {
  return problem.phases[static_cast<std::size_t>(phase)];
}

std::vector<int> contacts_of(const Phase& phase) {
  std::vector<int> contacts;
  for (const PhaseContact& contact : phase.contacts) contacts.push_back(contact.contact);
  return contacts;
}

}  // namespace

NodeFunctions::NodeFunctions(const MotionProblem& problem, const ContactSchedule& schedule, int phase,
                             const PhaseContacts& contacts)
    : nv_(problem.robot.nv()),
      nu_(problem.robot.nu()),
      num_chosen_(static_cast<int>(contacts.chosen_rows.size())),
      intervals_(phase_of(problem, phase).intervals),
      free_duration_(!phase_of(problem, phase).duration.is_fixed()),
      torques_(problem.robot),
      placement_(problem, schedule, phase, contacts.landing),
      cost_(problem),
      dynamics_(problem.robot, contacts_of(phase_of(problem, phase)), contacts.chosen_rows) {
  const auto& held = phase_of(problem, phase).contacts;
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    const PhaseContact& contact = held[static_cast<std::size_t>(i)];
    const Surface& surface = problem.surfaces[static_cast<std::size_t>(contact.surface)];
    friction_.emplace_back(problem.friction_model, surface, cone_smoothing(problem, surface.friction, held.size()));
    contact_names_.push_back(problem.robot.contacts()[static_cast<std::size_t>(contact.contact)].name);
    opens_.push_back(schedule.opens(phase, i));
    if (schedule.stances()[static_cast<std::size_t>(schedule.stance(phase, i))].lands()) landed_.push_back(i);
  }
  anchor_axes_.setZero(3 * num_contacts(), num_places());
  for (std::size_t l = 0; l < landed_.size(); ++l) {
    const int surface = held[static_cast<std::size_t>(landed_[l])].surface;
    anchor_axes_.block<3, 2>(3 * landed_[l], static_cast<Index>(2 * l)) =
        problem.surfaces[static_cast<std::size_t>(surface)].axes();
  }

  const double size = problem.robot.size();
  force_scale_ = 1.0 / problem.robot.weight();
  dynamics_scale_.setConstant(nv_, force_scale_);
  dynamics_scale_.segment<3>(3) /= size;
  for (int i = 0; i < 6; ++i) force_names_.push_back(std::string("base ") + kBaseForce[i]);
  for (int i = 0; i < nu_; ++i) {
    if (!problem.robot.joint_is_prismatic()[static_cast<std::size_t>(i)]) dynamics_scale_(6 + i) /= size;
    force_names_.push_back(problem.robot.joint_names()[static_cast<std::size_t>(i)]);
  }
}

int NodeFunctions::contact_row(int k, int contact) const {
  int row = nv_;
  for (int i = 0; i < contact; ++i) row += unloads(k, i) ? 3 : friction_[static_cast<std::size_t>(i)].count();
  return row;
}

double NodeFunctions::lower(int k, int row) const {
  return row < placement_row(k) ? 0.0 : placement_.lower(k, row - placement_row(k));
}

double NodeFunctions::upper(int k, int row) const {
  if (row >= placement_row(k)) return placement_.upper(k, row - placement_row(k));
  if (row >= torque_row(k)) return std::numeric_limits<double>::infinity();
  for (int i = 0; i < num_contacts(); ++i) {
    if (row >= contact_row(k, i) && row < contact_row(k, i + 1) && !unloads(k, i)) {
      return std::numeric_limits<double>::infinity();
    }
  }
  return 0.0;
}

std::string NodeFunctions::describe_row(int k, int row) const {
  if (row < nv_) return force_names_[static_cast<std::size_t>(row)] + ", equations of motion";
  if (row >= placement_row(k)) return placement_.describe(k, row - placement_row(k));
  if (row >= torque_row(k)) return torques_.describe(row - torque_row(k));
  int contact = 0;
  while (row >= contact_row(k, contact + 1)) ++contact;
  return contact_names_[static_cast<std::size_t>(contact)] +
         (unloads(k, contact) ? ", force before it opens" : ", friction cone");
}

// kd = 2/h, kp = 1/h² pull a contact's error down by three from node to node: docs/transcription.md. h = T / intervals.
Eigen::Vector2d NodeFunctions::gains(double duration, int derivative) const {
  const double n = intervals_, T = duration;
  const Eigen::Vector2d at(2.0 * n / T, n * n / (T * T));
  if (derivative == 0) return at;
  if (derivative == 1) return {-at(0) / T, -2.0 * at(1) / T};
  return {2.0 * at(0) / (T * T), 6.0 * at(1) / (T * T)};
}

DynamicsPoint NodeFunctions::dynamics_point(const NodePoint& point) const {
  const Eigen::Vector2d g = gains(point.duration, 0);
  return {point.q, point.v, point.a, point.tau, point.anchors, {g(0), g(1)}, point.w};
}

void NodeFunctions::fill_rows(const NodePoint& point, NodeValues& values) {
  const int k = point.node;
  values.forces = dynamics_.forces();
  values.rows.resize(num_rows(k));
  values.rows.head(nv_) = dynamics_.residual().cwiseProduct(dynamics_scale_);
  for (int i = 0; i < num_contacts(); ++i) {
    const Eigen::Vector3d force = values.forces.segment<3>(3 * i);
    const int row = contact_row(k, i);
    if (unloads(k, i)) {
      values.rows.segment<3>(row) = force_scale_ * force;
    } else {
      const FrictionLimit& friction = friction_[static_cast<std::size_t>(i)];
      values.rows.segment(row, friction.count()) = force_scale_ * friction.rows(force);
    }
  }
  torques_.evaluate(point.q.tail(nu_), point.v.tail(nu_), point.tau, values.rows.segment(torque_row(k), torques_.count()));
  placement_.evaluate(k, dynamics_.terms(), point.v, point.anchors,
                      values.rows.segment(placement_row(k), placement_.count(k)));
  values.cost = cost_.value(point, dynamics_.terms(), values.forces);
}

void NodeFunctions::evaluate(const NodePoint& point, NodeValues& values) {
  dynamics_.evaluate(dynamics_point(point));
  fill_rows(point, values);
}

void NodeFunctions::gather(const PointDerivatives& derivatives, Eigen::Ref<MatrixXd> result, double duration) const {
  result.leftCols(num_variables()) << derivatives.q, derivatives.v, derivatives.a, derivatives.tau, derivatives.w;
  if (free_duration_) result.col(num_variables()) = derivatives.gains * gains(duration, 1);
  result.rightCols(num_places()) = -gains(duration, 0)(1) * derivatives.e * anchor_axes_;
}

void NodeFunctions::evaluate_with_derivatives(const NodePoint& point, NodeValues& values) {
  dynamics_.evaluate_with_derivatives(dynamics_point(point));
  fill_rows(point, values);
  const int k = point.node;

  MatrixXd& jacobian = values.rows_jacobian;
  jacobian.setZero(num_rows(k), num_columns());
  gather(dynamics_.residual_derivatives(), jacobian.topRows(nv_), point.duration);
  jacobian.topRows(nv_) = dynamics_scale_.asDiagonal() * jacobian.topRows(nv_);
  forces_jacobian_.resize(values.forces.size(), num_columns());
  gather(dynamics_.force_derivatives(), forces_jacobian_, point.duration);
  for (int i = 0; i < num_contacts(); ++i) {
    const auto force = forces_jacobian_.middleRows<3>(3 * i);
    const int row = contact_row(k, i);
    if (unloads(k, i)) {
      jacobian.middleRows<3>(row) = force_scale_ * force;
    } else {
      const FrictionLimit& friction = friction_[static_cast<std::size_t>(i)];
      jacobian.middleRows(row, friction.count()) = force_scale_ * friction.slopes(values.forces.segment<3>(3 * i)) * force;
    }
  }
  auto torque_rows = jacobian.middleRows(torque_row(k), torques_.count());
  torques_.derivatives(point.q.tail(nu_), point.v.tail(nu_), torque_rows.middleCols(6, nu_),
                       torque_rows.middleCols(nv_ + 6, nu_), torque_rows.middleCols(3 * nv_, nu_));
  auto placement_rows = jacobian.bottomRows(placement_.count(k));
  MatrixXd d_anchors(placement_.count(k), 3 * num_contacts());
  placement_.derivatives(k, placement_rows.leftCols(nv_), placement_rows.middleCols(nv_, nv_), d_anchors);
  placement_rows.rightCols(num_places()) = d_anchors * anchor_axes_;

  cost_.derivatives(point, dynamics_.terms(), values.forces, false, cost_derivatives_);
  values.cost_gradient.setZero(num_columns());
  values.cost_gradient.head(3 * nv_ + nu_) = cost_derivatives_.gradient;
  values.cost_gradient += forces_jacobian_.transpose() * cost_derivatives_.force_gradient;
  if (free_duration_) {  // the running cost is in proportion to the duration
    values.cost_gradient(num_variables()) += cost_.running(point, dynamics_.terms(), values.forces) / point.duration;
  }

  const Eigen::Matrix3d Jr = so3::right_jacobian(point.theta);
  jacobian.middleCols<3>(3) *= Jr;
  values.cost_gradient.segment<3>(3) = (Jr.transpose() * values.cost_gradient.segment<3>(3)).eval();
}

void NodeFunctions::hessian(const NodePoint& point, double cost_factor, const VectorXd& multipliers, MatrixXd& result) {
  const DynamicsPoint at = dynamics_point(point);
  dynamics_.evaluate_with_derivatives(at);
  const VectorXd& forces = dynamics_.forces();
  const int k = point.node, variables = num_variables();
  const VectorXd mu = dynamics_scale_.cwiseProduct(multipliers.head(nv_));
  forces_jacobian_.resize(forces.size(), num_columns());
  gather(dynamics_.force_derivatives(), forces_jacobian_, point.duration);

  // Cost, with forces for now as variables of their own. `pull` is the gradient in the tangent of the rotation, below.
  cost_.derivatives(point, dynamics_.terms(), forces, true, cost_derivatives_);
  result.setZero(num_columns(), num_columns());
  result.topLeftCorner(3 * nv_ + nu_, 3 * nv_ + nu_) = cost_factor * cost_derivatives_.hessian;
  VectorXd force_pull = cost_factor * cost_derivatives_.force_gradient;
  Eigen::Vector3d pull = cost_factor * cost_derivatives_.gradient.segment<3>(3);
  if (free_duration_) {
    VectorXd slope = forces_jacobian_.transpose() * cost_derivatives_.force_gradient;
    slope.head(3 * nv_ + nu_) += cost_derivatives_.running_gradient;
    result.col(variables) += cost_factor / point.duration * slope;
    result.row(variables) += cost_factor / point.duration * slope.transpose();
  }

  // What bends in the forces themselves: cones and force cost, through f(q, v, a, tau, w, shared).
  MatrixXd bent(forces.size(), num_columns());
  for (int i = 0; i < num_contacts(); ++i) {
    const Eigen::Vector3d force = forces.segment<3>(3 * i);
    Eigen::Matrix3d curvature = (cost_factor * cost_.force_curvature(point)).asDiagonal();
    const int row = contact_row(k, i);
    if (unloads(k, i)) {
      force_pull.segment<3>(3 * i) += force_scale_ * multipliers.segment<3>(row);
    } else {
      const FrictionLimit& friction = friction_[static_cast<std::size_t>(i)];
      const VectorXd on_rows = force_scale_ * multipliers.segment(row, friction.count());
      force_pull.segment<3>(3 * i) += friction.slopes(force).transpose() * on_rows;
      curvature += friction.curvature(force, on_rows);
    }
    bent.middleRows<3>(3 * i) = curvature * forces_jacobian_.middleRows<3>(3 * i);
  }
  result.noalias() += forces_jacobian_.transpose() * bent;
  pull += (dynamics_.residual_derivatives().q.transpose() * mu +
           dynamics_.force_derivatives().q.transpose() * force_pull).segment<3>(3);

  // What bends in c and f.
  const PointHessian& inner = dynamics_.hessian(at, mu, force_pull);
  result.topLeftCorner(nv_, nv_) += inner.qq;
  result.block(nv_, nv_, nv_, nv_) += inner.vv;
  const auto add_mixed = [&](const MatrixXd& block, Index row, Index column) {
    result.block(row, column, block.rows(), block.cols()) += block;
    result.block(column, row, block.cols(), block.rows()) += block.transpose();
  };
  add_mixed(inner.qv, 0, nv_);
  add_mixed(inner.qa, 0, 2 * nv_);
  add_mixed(inner.qtau, 0, 3 * nv_);
  add_mixed(inner.qw, 0, 3 * nv_ + nu_);
  add_mixed(-at.stabilisation.kp * inner.qe * anchor_axes_, 0, first_place());
  if (free_duration_) {
    const Eigen::Vector2d slope = gains(point.duration, 1);
    add_mixed(inner.qgains * slope, 0, variables);
    add_mixed(inner.vgains * slope, nv_, variables);
    add_mixed(-slope(1) * inner.de.transpose() * anchor_axes_, variables, first_place());
    const ContactKinematics& kinematics = dynamics_.kinematics();
    const Eigen::Vector2d on_gains(inner.de.dot(kinematics.jacobian() * point.v),
                                   inner.de.dot(kinematics.positions() - point.anchors));
    result(variables, variables) += on_gains.dot(gains(point.duration, 2));
  }

  // Torque limits, and places of contacts.
  VectorXd joints = VectorXd::Zero(nu_), rates = VectorXd::Zero(nu_);
  torques_.add_hessian(point.q.tail(nu_), point.v.tail(nu_), multipliers.segment(torque_row(k), torques_.count()), joints,
                       rates);
  result.diagonal().segment(6, nu_) += joints;
  result.diagonal().segment(nv_ + 6, nu_) += rates;
  if (const int count = placement_.count(k); count > 0) {
    const VectorXd on_rows = multipliers.segment(placement_row(k), count);
    VectorXd unused(count);
    placement_.evaluate(k, dynamics_.terms(), point.v, point.anchors, unused);
    MatrixXd dq(count, nv_), dv(count, nv_), d_anchors(count, 3 * num_contacts());
    placement_.derivatives(k, dq, dv, d_anchors);
    pull += (dq.transpose() * on_rows).segment<3>(3);
    MatrixXd qv = MatrixXd::Zero(nv_, nv_);
    placement_.add_hessian(k, on_rows, result.topLeftCorner(nv_, nv_), qv);
    add_mixed(qv, 0, nv_);
  }

  // From the tangent at R to theta, R = chart exp(theta): x = Jr dtheta + 1/2 (DJr[dtheta]) dtheta.
  const Eigen::Matrix3d Jr = so3::right_jacobian(point.theta);
  result.middleRows<3>(3) = (Jr.transpose() * result.middleRows<3>(3)).eval();
  result.middleCols<3>(3) = (result.middleCols<3>(3) * Jr).eval();
  result.block<3, 3>(3, 3) += so3::right_jacobian_derivative(point.theta, pull);
}

}  // namespace prowl

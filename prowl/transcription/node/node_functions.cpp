#include "prowl/transcription/node/node_functions.hpp"

#include <algorithm>
#include <limits>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/congruence.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr const char* kBaseForce[] = {"force x", "force y", "force z", "moment x", "moment y", "moment z"};

/// At each node of the phase: its duration over the step h of the contact gains, which is the
/// longest step from the start of the motion to the one after the node (other phases at their mean
/// durations).
///
/// Not shorter than the step after: the explicit half of the trapezoid then at most halves an
/// error, and the implicit half shrinks it for any gain, while gains for the step before let errors
/// grow with the steps. Not shorter than the steps before: a short step would remove the contact
/// error of long steps too fast for the certificate. docs/transcription.md, "Steps of different
/// length".
std::vector<double> per_gain_step(const DiscreteProblem& discrete, int phase) {
  std::vector<double> result;
  double longest = 0.0;  // [s]
  for (int p = 0; p <= phase; ++p) {
    const Duration& range = discrete.problem.phases[p].duration;
    const PhaseMesh& mesh = discrete.mesh.phases[p];
    const double duration = 0.5 * (range.min + range.max);
    result.clear();
    for (int k = 0; k <= mesh.intervals(); ++k) {
      longest = std::max(longest, mesh.step(std::min(k, mesh.intervals() - 1), duration));
      result.push_back(duration / longest);
    }
  }
  return result;
}

/// The surface under a contact, as rough as the motion may count on.
Surface surface_used(const MotionProblem& problem, const PhaseContact& contact) {
  Surface surface = problem.surfaces[contact.surface];
  surface.friction *= 1.0 - problem.margins.friction;
  return surface;
}

}  // namespace

double cone_smoothing(const MotionProblem& problem, const Phase& phase, const PhaseContact& contact) {
  const double friction = surface_used(problem, contact).friction;
  const double sharpest = std::min(0.01, 0.2 * friction / static_cast<double>(phase.contacts.size()));
  return std::max(problem.robot.weight() * sharpest, friction * least_load(problem, phase, contact));
}

NodeFunctions::NodeFunctions(const DiscreteProblem& discrete, int phase, const PhaseContacts& contacts,
                             const StabilisationOfStep& stabilisation, PlacementKind placement)
    : nv_(discrete.problem.robot.nv()),
      nu_(discrete.problem.robot.nu()),
      num_chosen_(static_cast<int>(contacts.chosen_rows.size())),
      intervals_(discrete.mesh.phases[phase].intervals()),
      free_duration_(!discrete.problem.phases[phase].duration.is_fixed()),
      stabilisation_(stabilisation),
      per_gain_step_(per_gain_step(discrete, phase)),
      torques_(discrete.problem.robot),
      placement_(placement == PlacementKind::motion_of_contacts ? PlacementRows::motion_of_contacts(discrete, phase)
                                                                : PlacementRows(discrete, phase, contacts.landing)),
      terms_(discrete, phase),
      cost_(discrete.problem),
      term_costs_(discrete, phase),
      dynamics_(discrete.problem.robot, contact_indices(discrete.problem.phases[phase].contacts),
                contacts.chosen_rows) {
  for (const MeshNode& node : discrete.nodes) {
    if (node.phase == phase) times_.push_back(node.time);
  }
  const MotionProblem& problem = discrete.problem;
  const ContactSchedule& schedule = discrete.schedule;
  const auto& held = problem.phases[phase].contacts;
  for (int i = 0; i < static_cast<int>(held.size()); ++i) {
    const PhaseContact& contact = held[i];
    const Surface surface = surface_used(problem, contact);
    const Phase& held_in = problem.phases[phase];
    friction_.emplace_back(problem.friction_model, surface, cone_smoothing(problem, held_in, contact),
                           least_load(problem, held_in, contact));
    coefficients_.push_back(surface.friction);
    contact_names_.push_back(problem.robot.contacts()[contact.contact].name);
    opens_.push_back(schedule.opens(phase, i));
    if (schedule.stances()[schedule.stance(phase, i)].lands()) landed_.push_back(i);
  }
  for (const int contact : landed_) {
    const int surface = held[contact].surface;
    landed_axes_.push_back(problem.surfaces[surface].axes());
  }

  placement_anchors_.resize(placement_.most_rows(), 3 * num_contacts());
  rotation_.resize(std::max(num_rows(0), num_rows(intervals_)) + placement_.most_rows() + terms_.most_rows(), 3);

  const double size = problem.robot.size();
  force_scale_ = 1.0 / problem.robot.weight();
  if (!problem.margins.phases.empty()) {
    cone_margins_.resize(num_contacts(), intervals_ + 1);
    torque_margins_.resize(nu_, intervals_ + 1);
    for (int k = 0; k <= intervals_; ++k) {
      const double fraction = discrete.mesh.phases[phase].node_time(k, 1.0);
      cone_margins_.col(k) = force_scale_ * margin_at(problem.margins.phases[phase].cone, fraction);
      torque_margins_.col(k) = margin_at(problem.margins.phases[phase].torque, fraction);
    }
  }
  dynamics_scale_.setConstant(nv_, force_scale_);
  dynamics_scale_.segment<3>(3) /= size;
  for (int i = 0; i < 6; ++i) force_names_.push_back(std::string("base ") + kBaseForce[i]);
  for (int i = 0; i < nu_; ++i) {
    if (!problem.robot.joint_is_prismatic()[i]) dynamics_scale_(6 + i) /= size;
    force_names_.push_back(problem.robot.joint_names()[i]);
  }
}

int NodeFunctions::contact_row(int k, int contact) const {
  int row = nv_;
  for (int i = 0; i < contact; ++i) row += unloads(k, i) ? 3 : friction_[i].count();
  return row;
}

double NodeFunctions::lower(int k, int row) const {
  if (row >= term_row(k)) return terms_.lower(k, row - term_row(k));
  if (row >= placement_row(k)) return placement_.lower(k, row - placement_row(k));
  if (cone_margins_.size() == 0) return 0.0;
  if (row >= torque_row(k)) {
    const int limit = row - torque_row(k);
    return torque_margins_(torques_.joint(limit), k) / torques_.largest(limit);
  }
  for (int i = 0; i < num_contacts(); ++i) {
    if (row >= contact_row(k, i) && row < contact_row(k, i + 1) && !unloads(k, i)) return cone_margins_(i, k);
  }
  return 0.0;
}

double NodeFunctions::upper(int k, int row) const {
  if (row >= term_row(k)) return terms_.upper(k, row - term_row(k));
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
  if (row < nv_) return force_names_[row] + ", equations of motion";
  if (row >= term_row(k)) return terms_.describe(k, row - term_row(k));
  if (row >= placement_row(k)) return placement_.describe(k, row - placement_row(k));
  if (row >= torque_row(k)) return torques_.describe(row - torque_row(k));
  int contact = 0;
  while (row >= contact_row(k, contact + 1)) ++contact;
  return contact_names_[contact] + (unloads(k, contact) ? ", force before it opens" : ", friction cone");
}

std::optional<MotionLimit> NodeFunctions::limit_of_row(const RobotModel& robot, int k, int row) const {
  if (row < nv_) return std::nullopt;
  if (row >= term_row(k)) return terms_.limit(k, row - term_row(k));
  if (row >= placement_row(k)) {
    const PlacementRows::Kind kind = placement_.kind(k, row - placement_row(k));
    if (kind == PlacementRows::Kind::foothold || kind == PlacementRows::Kind::velocity) return std::nullopt;
    const int contact = placement_.contact(k, row - placement_row(k));
    return MotionLimit{.kind = kind == PlacementRows::Kind::inside ? LimitKind::foothold : LimitKind::clearance,
                       .subject = robot.contacts()[contact].name,
                       .unit = "m",
                       .si = robot.size(),
                       .size = robot.size()};
  }
  if (row >= torque_row(k)) {
    MotionLimit limit = limit_of_joint(robot, LimitKind::torque, torques_.joint(row - torque_row(k)));
    limit.si = torques_.largest(row - torque_row(k));
    return limit;
  }
  int contact = 0;
  while (row >= contact_row(k, contact + 1)) ++contact;
  if (unloads(k, contact)) return std::nullopt;
  return MotionLimit{.kind = LimitKind::friction,
                     .subject = contact_names_[contact],
                     .unit = "N",
                     .si = 1.0 / force_scale_,
                     .size = coefficients_[contact] / force_scale_};
}

// h = T / n.
Eigen::Vector2d NodeFunctions::gains(const NodePoint& point, int derivative) const {
  const double n = per_gain_step_[point.node], T = point.duration;
  const Eigen::Vector2d at(stabilisation_.rate * n / T, stabilisation_.stiffness * n * n / (T * T));
  if (derivative == 0) return at + Eigen::Vector2d(stabilisation_.damping, stabilisation_.spring);
  if (derivative == 1) return {-at(0) / T, -2.0 * at(1) / T};
  return {2.0 * at(0) / (T * T), 6.0 * at(1) / (T * T)};
}

void NodeFunctions::set_point(const NodePoint& point) {
  const Eigen::Vector2d g = gains(point, 0);
  at_.q = point.q;
  at_.v = point.v;
  at_.a = point.a;
  at_.tau = point.tau;
  at_.anchors = point.anchors;
  at_.stabilisation = {g(0), g(1)};
  at_.chosen_forces = point.w;
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
      const FrictionLimit& friction = friction_[i];
      values.rows.segment(row, friction.count()) = force_scale_ * friction.rows(force);
    }
  }
  torques_.evaluate(point.q.tail(nu_), point.v.tail(nu_), point.tau,
                    values.rows.segment(torque_row(k), torques_.count()));
  placement_.evaluate(k, dynamics_.terms(), point.v, point.anchors,
                      values.rows.segment(placement_row(k), placement_.count(k)));
  const NodeReading at_node{dynamics_.terms(), point.q, point.v, point.tau, values.forces, times_[k]};
  terms_.evaluate(k, at_node, values.rows.segment(term_row(k), terms_.count(k)));
  values.cost = cost_.value(point, dynamics_.terms(), values.forces);
  const TermCosts::Value of_terms = term_costs_.value(point, at_node);
  values.cost += of_terms.running + of_terms.at_moment;
  running_cost_ = cost_.running() + of_terms.running;
}

void NodeFunctions::evaluate(const NodePoint& point, NodeValues& values) {
  set_point(point);
  dynamics_.evaluate(at_);
  fill_rows(point, values);
}

void NodeFunctions::evaluate_with_derivatives(const NodePoint& point, NodeValues& values) {
  set_point(point);
  dynamics_.evaluate_with_derivatives(at_);
  fill_rows(point, values);
  fill_derivatives(point, values);
}

void NodeFunctions::gather(const PointDerivatives& derivatives, const NodePoint& point,
                           Eigen::Ref<MatrixXd> result) const {
  result.leftCols(num_variables()) << derivatives.q, derivatives.v, derivatives.a, derivatives.tau, derivatives.w;
  if (free_duration_) result.col(num_variables()).noalias() = derivatives.gains.lazyProduct(gains(point, 1));
  const double kp = gains(point, 0)(1);
  for (std::size_t l = 0; l < landed_.size(); ++l) {
    result.middleCols<2>(first_foothold_variable() + static_cast<Index>(2 * l)).noalias() =
        derivatives.e.middleCols<3>(3 * landed_[l]).lazyProduct(-kp * landed_axes_[l]);
  }
}

void NodeFunctions::fill_derivatives(const NodePoint& point, NodeValues& values) {
  const int k = point.node;
  MatrixXd& jacobian = values.rows_jacobian;
  jacobian.resize(num_rows(k), num_columns());
  gather(dynamics_.residual_derivatives(), point, jacobian.topRows(nv_));
  jacobian.topRows(nv_).array().colwise() *= dynamics_scale_.array();
  forces_jacobian_.resize(values.forces.size(), num_columns());
  gather(dynamics_.force_derivatives(), point, forces_jacobian_);
  for (int i = 0; i < num_contacts(); ++i) {
    const auto force = forces_jacobian_.middleRows<3>(3 * i);
    const int row = contact_row(k, i);
    if (unloads(k, i)) {
      jacobian.middleRows<3>(row) = force_scale_ * force;
    } else {
      const FrictionLimit& friction = friction_[i];
      const FrictionLimit::Slopes slopes = force_scale_ * friction.slopes(values.forces.segment<3>(3 * i));
      kernels_.set(jacobian.middleRows(row, friction.count()), slopes, force);
    }
  }
  auto limits = jacobian.bottomRows(num_rows(k) - torque_row(k));
  limits.setZero();
  auto torque_rows = limits.topRows(torques_.count());
  torques_.derivatives(point.q.tail(nu_), point.v.tail(nu_), torque_rows.middleCols(6, nu_),
                       torque_rows.middleCols(nv_ + 6, nu_), torque_rows.middleCols(3 * nv_, nu_));
  auto placement_rows = limits.middleRows(placement_row(k) - torque_row(k), placement_.count(k));
  auto d_anchors = placement_anchors_.topRows(placement_.count(k));
  placement_.derivatives(k, placement_rows.leftCols(nv_), placement_rows.middleCols(nv_, nv_), d_anchors);
  for (std::size_t l = 0; l < landed_.size(); ++l) {
    placement_rows.middleCols<2>(first_foothold_variable() + static_cast<Index>(2 * l)).noalias() =
        d_anchors.middleCols<3>(3 * landed_[l]).lazyProduct(landed_axes_[l]);
  }
  terms_.derivatives(k, forces_jacobian_, limits.bottomRows(terms_.count(k)));

  cost_.derivatives(point, values.forces, cost_derivatives_);
  running_gradient_.noalias() = forces_jacobian_.transpose() * cost_derivatives_.force_gradient;
  values.cost_gradient = running_gradient_;
  running_gradient_.head(3 * nv_ + nu_) += cost_derivatives_.running_gradient;
  values.cost_gradient.head(3 * nv_ + nu_) += cost_derivatives_.gradient;
  term_costs_.add_gradient(point, forces_jacobian_, values.cost_gradient, running_gradient_);
  if (free_duration_) {  // the running cost is proportional to the duration
    values.cost_gradient(num_variables()) += running_cost_ / point.duration;
  }

  const Eigen::Matrix3d Jr = so3::right_jacobian(point.theta);
  auto rotation = rotation_.topRows(num_rows(k));
  rotation = jacobian.middleCols<3>(3);
  jacobian.middleCols<3>(3).noalias() = rotation.lazyProduct(Jr);
  rotation_gradient_ = values.cost_gradient.segment<3>(3);
  values.cost_gradient.segment<3>(3).noalias() = Jr.transpose() * rotation_gradient_;
}

void NodeFunctions::hessian(const NodePoint& point, double cost_factor, const VectorXd& multipliers, MatrixXd& result) {
  linearise(point, cost_factor, multipliers, unused_, result);
  result.triangularView<Eigen::StrictlyUpper>() = result.transpose();
}

void NodeFunctions::linearise(const NodePoint& point, double cost_factor, const VectorXd& multipliers,
                              NodeValues& values, MatrixXd& hessian) {
  evaluate_with_derivatives(point, values);
  hessian.resize(num_columns(), num_columns());
  Eigen::Vector3d pull = cost_factor * rotation_gradient_;  // total gradient in the tangent of the rotation
  if (hessian_kind_ == HessianKind::exact) {
    set_force_hessian(point, cost_factor, multipliers, hessian);
    add_dynamics_hessian(point, multipliers, hessian);
    add_limits_hessian(point, multipliers, hessian);
    for (Index row = 0; row < multipliers.size(); ++row) pull += multipliers(row) * rotation_.row(row).transpose();
  } else {
    const int forces = contact_row(point.node, 0), end = torque_row(point.node);
    on_cones_.setZero(multipliers.size());
    if (hessian_kind_ == HessianKind::gauss_newton_with_cones)
      on_cones_.segment(forces, end - forces) = multipliers.segment(forces, end - forces);
    set_force_hessian(point, cost_factor, on_cones_, hessian);
  }
  add_cost_hessian(point, cost_factor, hessian);
  // From the tangent at R to theta, R = chart exp(theta): x = Jr dtheta + 1/2 (DJr[dtheta]) dtheta.
  replace_block(hessian, 3, so3::right_jacobian(point.theta));
  hessian.block<3, 3>(3, 3) += so3::right_jacobian_derivative(point.theta, pull);
}

// At fixed forces, plus the duration, to which the running cost is proportional.
void NodeFunctions::add_cost_hessian(const NodePoint& point, double cost_factor, MatrixXd& result) {
  cost_.add_hessian(point, cost_factor, result);
  term_costs_.add_hessian(point, cost_factor, result);
  if (!free_duration_) return;
  const int duration = num_variables();
  const double factor = cost_factor / point.duration;
  result.row(duration).head(duration) += factor * running_gradient_.head(duration).transpose();
  result.col(duration).tail(num_foothold_variables()) += factor * running_gradient_.tail(num_foothold_variables());
  result(duration, duration) += 2.0 * factor * running_gradient_(duration);
}

// Curvature in the forces: cones and force cost, through f(q, v, a, tau, w, shared). The user's terms of forces only
// pull here: their curvature is that of TermEvaluation.
void NodeFunctions::set_force_hessian(const NodePoint& point, double cost_factor, const VectorXd& multipliers,
                                      MatrixXd& result) {
  const VectorXd& forces = dynamics_.forces();
  force_pull_ = cost_factor * cost_derivatives_.force_gradient;
  bending_.resize(num_columns(), forces.size());
  bent_.resize(num_columns(), forces.size());
  Index rows = 0;
  for (int i = 0; i < num_contacts(); ++i) {
    const Eigen::Vector3d force = forces.segment<3>(3 * i);
    Eigen::Matrix3d curvature = (cost_factor * cost_.force_curvature(point)).asDiagonal();
    const int row = contact_row(point.node, i);
    if (unloads(point.node, i)) {
      force_pull_.segment<3>(3 * i) += force_scale_ * multipliers.segment<3>(row);
    } else {
      const FrictionLimit& friction = friction_[i];
      const FrictionLimit::Rows on_rows = force_scale_ * multipliers.segment(row, friction.count());
      force_pull_.segment<3>(3 * i).noalias() += friction.slopes(force).transpose().lazyProduct(on_rows);
      curvature += friction.curvature(force, on_rows);
    }
    if (curvature.isZero(0.0)) continue;
    bending_.middleCols<3>(rows) = forces_jacobian_.middleRows<3>(3 * i).transpose();
    bent_.middleCols<3>(rows).noalias() = bending_.middleCols<3>(rows).lazyProduct(curvature);
    rows += 3;
  }
  kernels_.set_lower(result, bending_.leftCols(rows), bent_.leftCols(rows));
  terms_.add_force_pull(point.node, multipliers.segment(term_row(point.node), terms_.count(point.node)), force_pull_);
  term_costs_.add_force_pull(point, cost_factor, force_pull_);
}

// Curvature of c and f.
void NodeFunctions::add_dynamics_hessian(const NodePoint& point, const VectorXd& multipliers, MatrixXd& result) {
  mu_ = dynamics_scale_.cwiseProduct(multipliers.head(nv_));
  const PointHessian& inner = dynamics_.hessian(at_, mu_, force_pull_);
  result.topLeftCorner(nv_, nv_) += inner.qq;
  result.block(nv_, nv_, nv_, nv_) += inner.vv;
  auto q_columns = result.leftCols(nv_);
  q_columns.middleRows(nv_, nv_) += inner.qv.transpose();
  q_columns.middleRows(2 * nv_, nv_) += inner.qa.transpose();
  q_columns.middleRows(3 * nv_, nu_) += inner.qtau.transpose();
  q_columns.middleRows(3 * nv_ + nu_, num_chosen_) += inner.qw.transpose();
  for (std::size_t l = 0; l < landed_.size(); ++l) {
    q_columns.middleRows<2>(first_foothold_variable() + static_cast<Index>(2 * l)) +=
        (-at_.stabilisation.kp * landed_axes_[l])
            .transpose()
            .lazyProduct(inner.qe.middleCols<3>(3 * landed_[l]).transpose());
  }
  if (!free_duration_) return;
  const int duration = num_variables();
  const Eigen::Vector2d slope = gains(point, 1);
  q_columns.row(duration) += slope.transpose().lazyProduct(inner.qgains.transpose());
  result.row(duration).segment(nv_, nv_) += slope.transpose().lazyProduct(inner.vgains.transpose());
  for (std::size_t l = 0; l < landed_.size(); ++l) {
    result.col(duration).segment<2>(first_foothold_variable() + static_cast<Index>(2 * l)) -=
        slope(1) * landed_axes_[l].transpose() * inner.de.segment<3>(3 * landed_[l]);
  }
  const Eigen::Vector2d on_gains(inner.vgains.col(0).dot(point.v),
                                 inner.de.dot(dynamics_.kinematics().positions() - point.anchors));
  result(duration, duration) += on_gains.dot(gains(point, 2));
}

// Torque limits, placement of contacts and the user's terms.
void NodeFunctions::add_limits_hessian(const NodePoint& point, const VectorXd& multipliers, MatrixXd& result) {
  const int k = point.node;
  joints_.setZero(nu_);
  rates_.setZero(nu_);
  torques_.add_hessian(point.q.tail(nu_), point.v.tail(nu_), multipliers.segment(torque_row(k), torques_.count()),
                       joints_, rates_);
  result.diagonal().segment(6, nu_) += joints_;
  result.diagonal().segment(nv_ + 6, nu_) += rates_;
  placement_.add_hessian(k, multipliers.segment(placement_row(k), placement_.count(k)), result.topLeftCorner(nv_, nv_),
                         result.block(nv_, 0, nv_, nv_));
  terms_.add_hessian(k, multipliers.segment(term_row(k), terms_.count(k)), result);
}

}  // namespace prowl

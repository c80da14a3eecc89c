#include "prowl/transcription/node_functions.hpp"

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"

namespace prowl {

namespace {

/// Smoothing of the friction cone's tip, as a part of the robot's weight: 0.8 N for HyQ.
constexpr double kConeSmoothing = 1e-3;

std::vector<int> contacts_of(const Phase& phase) {
  std::vector<int> contacts;
  for (const PhaseContact& contact : phase.contacts) contacts.push_back(contact.contact);
  return contacts;
}

std::vector<int> contacts_of(const std::vector<ContactPositionCost>& costs) {
  std::vector<int> contacts;
  for (const ContactPositionCost& cost : costs) contacts.push_back(cost.contact);
  return contacts;
}

}  // namespace

NodeFunctions::NodeFunctions(const MotionProblem& problem, const Phase& phase, const Eigen::VectorXd& anchors,
                             double step)
    : nv_(problem.robot.nv()),
      nu_(problem.robot.nu()),
      running_(problem.running_cost),
      terminal_(problem.terminal_cost),
      anchors_(anchors),
      // Pulls a contact's error down by three from node to node: docs/transcription.md.
      stabilisation_{2.0 / step, 1.0 / (step * step)},
      dynamics_(problem.robot, contacts_of(phase)),
      running_points_(contacts_of(running_.contact_positions)),
      terminal_points_(contacts_of(terminal_.contact_positions)) {
  const double weight = problem.robot.weight();
  const double height = problem.robot.nominal_configuration()(2);
  for (const PhaseContact& contact : phase.contacts) {
    const Surface& surface = problem.surfaces[static_cast<std::size_t>(contact.surface)];
    cones_.push_back({surface.normal, surface.friction, kConeSmoothing * weight});
  }
  row_scale_.setConstant(num_rows(), 1.0 / weight);
  row_scale_.segment<3>(3) /= height;
  for (int i = 0; i < nu_; ++i) {
    if (!problem.robot.joint_is_prismatic()[static_cast<std::size_t>(i)]) row_scale_(6 + i) /= height;
  }
}

DynamicsPoint NodeFunctions::dynamics_point(const NodePoint& point) const {
  return {point.q, point.v, point.a, point.tau, anchors_, stabilisation_};
}

void NodeFunctions::fill_rows(NodeValues& values) const {
  values.forces = dynamics_.forces();
  values.rows.resize(num_rows());
  values.rows.head(nv_) = dynamics_.residual();
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    values.rows(nv_ + c) = cones_[i].value(values.forces.segment<3>(3 * c));
  }
  values.rows.array() *= row_scale_.array();
}

void NodeFunctions::evaluate(const NodePoint& point, NodeValues& values) {
  dynamics_.evaluate(dynamics_point(point));
  fill_rows(values);
  values.cost = cost(point);
}

void NodeFunctions::evaluate_with_derivatives(const NodePoint& point, NodeValues& values) {
  dynamics_.evaluate_with_derivatives(dynamics_point(point));
  fill_rows(values);
  values.cost = cost(point);

  const PointDerivatives& dc = dynamics_.residual_derivatives();
  const PointDerivatives& df = dynamics_.force_derivatives();
  values.rows_jacobian.resize(num_rows(), num_variables());
  values.rows_jacobian.topRows(nv_) << dc.q, dc.v, dc.a, dc.tau;
  Eigen::VectorXd force_gradient;
  cost_derivatives(point, values.cost_gradient, force_gradient, nullptr);
  Eigen::MatrixXd forces_jacobian(df.q.rows(), num_variables());
  forces_jacobian << df.q, df.v, df.a, df.tau;
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const auto c = static_cast<Eigen::Index>(i);
    values.rows_jacobian.row(nv_ + c) =
        cones_[i].gradient(values.forces.segment<3>(3 * c)).transpose() * forces_jacobian.middleRows<3>(3 * c);
  }
  values.rows_jacobian = row_scale_.asDiagonal() * values.rows_jacobian;
  values.cost_gradient += forces_jacobian.transpose() * force_gradient;

  const Eigen::Matrix3d Jr = so3::right_jacobian(point.theta);
  values.rows_jacobian.middleCols<3>(3) *= Jr;
  values.cost_gradient.segment<3>(3) = (Jr.transpose() * values.cost_gradient.segment<3>(3)).eval();
}

double NodeFunctions::cost(const NodePoint& point) {
  double total = 0.0;
  const auto state_cost = [&](const QuadraticCost& cost, ContactKinematics& points) {
    double value = configuration_cost(cost.q_ref, cost.configuration_weight, point.q).value +
                   0.5 * point.v.cwiseAbs2().dot(cost.velocity_weight);
    points.set_configuration(dynamics_.terms());
    for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
      const ContactPositionCost& place = cost.contact_positions[i];
      const auto error = points.positions().segment<3>(static_cast<Eigen::Index>(3 * i)) - place.reference;
      value += 0.5 * error.cwiseAbs2().dot(place.weight);
    }
    return value;
  };
  if (point.cost_weight > 0.0) {
    double value = state_cost(running_, running_points_);
    value += 0.5 * point.a.cwiseAbs2().dot(running_.acceleration_weight);
    value += 0.5 * (point.tau - running_.tau_ref).cwiseAbs2().dot(running_.torque_weight);
    for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(cones_.size()); ++c) {
      value += 0.5 * dynamics_.forces().segment<3>(3 * c).cwiseAbs2().dot(running_.force_weight);
    }
    total += point.cost_weight * value;
  }
  if (point.terminal_weight > 0.0) total += point.terminal_weight * state_cost(terminal_, terminal_points_);
  return total;
}

void NodeFunctions::cost_derivatives(const NodePoint& point, Eigen::VectorXd& gradient, Eigen::VectorXd& force_gradient,
                                     Eigen::MatrixXd* hessian) {
  gradient.setZero(num_variables());
  force_gradient.setZero(dynamics_.forces().size());
  const auto add_state_cost = [&](const QuadraticCost& cost, ContactKinematics& points, double weight) {
    const ConfigurationCost configuration = configuration_cost(cost.q_ref, cost.configuration_weight, point.q);
    gradient.head(nv_) += weight * configuration.gradient;
    gradient.segment(nv_, nv_) += weight * cost.velocity_weight.cwiseProduct(point.v);
    if (hessian) {
      hessian->diagonal().head(nv_) += weight * configuration.hessian_diagonal;
      hessian->block<3, 3>(3, 3) += weight * configuration.hessian_rotation;
      hessian->diagonal().segment(nv_, nv_) += weight * cost.velocity_weight;
    }
    if (cost.contact_positions.empty()) return;
    points.set_configuration(dynamics_.terms());
    Eigen::VectorXd pull(points.rows()), stiffness(points.rows());
    for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
      const ContactPositionCost& place = cost.contact_positions[i];
      const auto row = static_cast<Eigen::Index>(3 * i);
      stiffness.segment<3>(row) = weight * place.weight;
      pull.segment<3>(row) =
          stiffness.segment<3>(row).cwiseProduct(points.positions().segment<3>(row) - place.reference);
    }
    gradient.head(nv_) += points.positions_dq().transpose() * pull;
    if (!hessian) return;
    Eigen::MatrixXd bend = points.positions_dq().transpose() * stiffness.asDiagonal() * points.positions_dq();
    points.add_position_hessian(pull, 1.0, bend);
    hessian->topLeftCorner(nv_, nv_) += bend;
  };
  if (point.cost_weight > 0.0) {
    const double weight = point.cost_weight;
    add_state_cost(running_, running_points_, weight);
    gradient.segment(2 * nv_, nv_) += weight * running_.acceleration_weight.cwiseProduct(point.a);
    gradient.tail(nu_) += weight * running_.torque_weight.cwiseProduct(point.tau - running_.tau_ref);
    for (Eigen::Index c = 0; c < static_cast<Eigen::Index>(cones_.size()); ++c) {
      force_gradient.segment<3>(3 * c) =
          weight * running_.force_weight.cwiseProduct(dynamics_.forces().segment<3>(3 * c));
    }
    if (hessian) {
      hessian->diagonal().segment(2 * nv_, nv_) += weight * running_.acceleration_weight;
      hessian->diagonal().tail(nu_) += weight * running_.torque_weight;
    }
  }
  if (point.terminal_weight > 0.0) add_state_cost(terminal_, terminal_points_, point.terminal_weight);
}

void NodeFunctions::hessian(const NodePoint& point, double cost_factor, const Eigen::VectorXd& multipliers,
                            Eigen::MatrixXd& result) {
  const DynamicsPoint at = dynamics_point(point);
  dynamics_.evaluate_with_derivatives(at);
  const PointDerivatives& dc = dynamics_.residual_derivatives();
  const PointDerivatives& df = dynamics_.force_derivatives();
  const Eigen::VectorXd scaled = row_scale_.cwiseProduct(multipliers);
  const Eigen::VectorXd mu = scaled.head(nv_);

  // Cost, forces for now as variables of their own.
  Eigen::VectorXd gradient, force_pull;
  result.setZero(num_variables(), num_variables());
  cost_derivatives(point, gradient, force_pull, &result);
  result *= cost_factor;
  gradient *= cost_factor;
  force_pull *= cost_factor;

  // What bends in the forces themselves: cones and force cost, through f(q, v, a, tau).
  Eigen::MatrixXd forces_jacobian(df.q.rows(), num_variables());
  forces_jacobian << df.q, df.v, df.a, df.tau;
  Eigen::MatrixXd bent = Eigen::MatrixXd::Zero(forces_jacobian.rows(), num_variables());
  for (std::size_t i = 0; i < cones_.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(3 * i);
    const double multiplier = scaled(nv_ + static_cast<Eigen::Index>(i));
    const Eigen::Vector3d force = dynamics_.forces().segment<3>(row);
    force_pull.segment<3>(row) += multiplier * cones_[i].gradient(force);
    Eigen::Matrix3d curvature = multiplier * cones_[i].hessian(force);
    curvature.diagonal() += cost_factor * point.cost_weight * running_.force_weight;
    bent.middleRows<3>(row) = curvature * forces_jacobian.middleRows<3>(row);
  }
  result.noalias() += forces_jacobian.transpose() * bent;

  // What bends in c and f.
  const PointHessian& inner = dynamics_.hessian(at, mu, force_pull);
  result.topLeftCorner(nv_, nv_) += inner.qq;
  result.block(nv_, nv_, nv_, nv_) += inner.vv;
  const auto add_mixed = [&](const Eigen::MatrixXd& block, Eigen::Index column) {
    result.block(0, column, nv_, block.cols()) += block;
    result.block(column, 0, block.cols(), nv_) += block.transpose();
  };
  add_mixed(inner.qv, nv_);
  add_mixed(inner.qa, 2 * nv_);
  add_mixed(inner.qtau, 3 * nv_);

  // From the tangent at R to theta, R = chart exp(theta): x = Jr dtheta + 1/2 (DJr[dtheta]) dtheta.
  const Eigen::Vector3d pull = gradient.segment<3>(3) + (dc.q.transpose() * mu + df.q.transpose() * force_pull).segment<3>(3);
  const Eigen::Matrix3d Jr = so3::right_jacobian(point.theta);
  result.middleRows<3>(3) = (Jr.transpose() * result.middleRows<3>(3)).eval();
  result.middleCols<3>(3) = (result.middleCols<3>(3) * Jr).eval();
  result.block<3, 3>(3, 3) += so3::right_jacobian_derivative(point.theta, pull);
}

}  // namespace prowl

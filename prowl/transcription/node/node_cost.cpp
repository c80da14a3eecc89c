#include "prowl/transcription/node/node_cost.hpp"

namespace prowl {

namespace {

std::vector<int> contacts_of(const std::vector<ContactPositionCost>& costs) {
  std::vector<int> contacts;
  for (const ContactPositionCost& cost : costs) contacts.push_back(cost.contact);
  return contacts;
}

}  // namespace

NodeCost::NodeCost(const MotionProblem& problem)
    : nv_(problem.robot.nv()),
      nu_(problem.robot.nu()),
      running_(problem.running_cost),
      terminal_(problem.terminal_cost) {}

void NodeCost::refer_to(const Eigen::VectorXd& q_ref, const Eigen::VectorXd& v_ref) {
  for (StateCost* state : {&running_, &terminal_}) {
    state->cost.q_ref = q_ref;
    state->cost.v_ref = v_ref;
  }
}

NodeCost::StateCost::StateCost(const QuadraticCost& quadratic)
    : cost(quadratic), points(contacts_of(quadratic.contact_positions)), stiffness(points.rows()), pull(points.rows()) {
  for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
    stiffness.segment<3>(static_cast<Eigen::Index>(3 * i)) = cost.contact_positions[i].weight;
  }
}

double NodeCost::StateCost::value(const NodePoint& point, const RigidBodyTerms& terms) {
  configuration_cost(cost.q_ref, cost.configuration_weight, point.q, configuration);
  velocity = point.v;
  if (cost.v_ref.size() > 0) velocity -= cost.v_ref;
  double value = configuration.value + 0.5 * velocity.cwiseAbs2().dot(cost.velocity_weight);
  if (cost.contact_positions.empty()) return value;
  points.set_configuration(terms);
  for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
    const ContactPositionCost& term = cost.contact_positions[i];
    const auto row = static_cast<Eigen::Index>(3 * i);
    const Eigen::Vector3d error = points.positions().segment<3>(row) - term.reference;
    pull.segment<3>(row) = term.weight.cwiseProduct(error);
    value += 0.5 * error.dot(pull.segment<3>(row));
  }
  return value;
}

double NodeCost::value(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces) {
  running_value_ = 0.0;
  if (point.cost_weight != 0.0) {
    const QuadraticCost& cost = running_.cost;
    double value = cost.time_weight + running_.value(point, terms);
    value += 0.5 * point.a.cwiseAbs2().dot(cost.acceleration_weight);
    value += 0.5 * (point.tau - cost.tau_ref).cwiseAbs2().dot(cost.torque_weight);
    for (Eigen::Index row = 0; row < forces.size(); row += 3) {
      value += 0.5 * forces.segment<3>(row).cwiseAbs2().dot(cost.force_weight);
    }
    running_value_ = point.cost_weight * value;
  }
  if (point.terminal_weight <= 0.0) return running_value_;
  return running_value_ + point.terminal_weight * terminal_.value(point, terms);
}

void NodeCost::StateCost::add_gradient(double weight, const NodePoint& point, Eigen::VectorXd& gradient) {
  const Eigen::Index nv = point.v.size();
  gradient.head(nv) += weight * configuration.gradient;
  gradient.segment(nv, nv) += weight * cost.velocity_weight.cwiseProduct(velocity);
  if (!cost.contact_positions.empty()) {
    gradient.head(nv).noalias() += weight * (points.positions_dq().transpose() * pull);
  }
}

void NodeCost::derivatives(const NodePoint& point, const Eigen::VectorXd& forces, Derivatives& result) {
  result.gradient.setZero(3 * nv_ + nu_);
  result.force_gradient.setZero(forces.size());
  if (point.cost_weight > 0.0) {
    const double weight = point.cost_weight;
    const QuadraticCost& cost = running_.cost;
    running_.add_gradient(weight, point, result.gradient);
    result.gradient.segment(2 * nv_, nv_) += weight * cost.acceleration_weight.cwiseProduct(point.a);
    result.gradient.tail(nu_) += weight * cost.torque_weight.cwiseProduct(point.tau - cost.tau_ref);
    for (Eigen::Index row = 0; row < forces.size(); row += 3) {
      result.force_gradient.segment<3>(row) = force_curvature(point).cwiseProduct(forces.segment<3>(row));
    }
  }
  result.running_gradient = result.gradient;
  if (point.terminal_weight > 0.0) terminal_.add_gradient(point.terminal_weight, point, result.gradient);
}

void NodeCost::StateCost::add_hessian(double weight, Eigen::MatrixXd& result) {
  const Eigen::Index nv = configuration.gradient.size();
  result.diagonal().head(nv) += weight * configuration.hessian_diagonal;
  result.block<3, 3>(3, 3) += weight * configuration.hessian_rotation;
  result.diagonal().segment(nv, nv) += weight * cost.velocity_weight;
  if (cost.contact_positions.empty()) return;
  stiff_points = weight * stiffness.asDiagonal() * points.positions_dq();
  auto on_q = result.topLeftCorner(nv, nv);
  on_q.noalias() += points.positions_dq().transpose() * stiff_points;
  points.add_position_hessian(pull, weight, on_q);
}

void NodeCost::add_hessian(const NodePoint& point, double factor, Eigen::MatrixXd& result) {
  if (point.cost_weight > 0.0) {
    const double weight = factor * point.cost_weight;
    running_.add_hessian(weight, result);
    result.diagonal().segment(2 * nv_, nv_) += weight * running_.cost.acceleration_weight;
    result.diagonal().segment(3 * nv_, nu_) += weight * running_.cost.torque_weight;
  }
  if (point.terminal_weight > 0.0) terminal_.add_hessian(factor * point.terminal_weight, result);
}

}  // namespace prowl

#include "prowl/transcription/node_cost.hpp"

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
      terminal_(problem.terminal_cost),
      running_points_(contacts_of(running_.contact_positions)),
      terminal_points_(contacts_of(terminal_.contact_positions)) {}

double NodeCost::state_cost(const QuadraticCost& cost, ContactKinematics& points, const NodePoint& point,
                            const RigidBodyTerms& terms) {
  double value = configuration_cost(cost.q_ref, cost.configuration_weight, point.q).value +
                 0.5 * point.v.cwiseAbs2().dot(cost.velocity_weight);
  if (cost.contact_positions.empty()) return value;
  points.set_configuration(terms);
  for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
    const ContactPositionCost& place = cost.contact_positions[i];
    const auto error = points.positions().segment<3>(static_cast<Eigen::Index>(3 * i)) - place.reference;
    value += 0.5 * error.cwiseAbs2().dot(place.weight);
  }
  return value;
}

double NodeCost::running(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces) {
  if (point.cost_weight == 0.0) return 0.0;
  double value = running_.time_weight + state_cost(running_, running_points_, point, terms);
  value += 0.5 * point.a.cwiseAbs2().dot(running_.acceleration_weight);
  value += 0.5 * (point.tau - running_.tau_ref).cwiseAbs2().dot(running_.torque_weight);
  for (Eigen::Index row = 0; row < forces.size(); row += 3) {
    value += 0.5 * forces.segment<3>(row).cwiseAbs2().dot(running_.force_weight);
  }
  return point.cost_weight * value;
}

double NodeCost::value(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces) {
  double value = running(point, terms, forces);
  if (point.terminal_weight > 0.0) {
    value += point.terminal_weight * state_cost(terminal_, terminal_points_, point, terms);
  }
  return value;
}

void NodeCost::add_state_cost(const QuadraticCost& cost, ContactKinematics& points, double weight,
                              const NodePoint& point, const RigidBodyTerms& terms, bool with_hessian,
                              Derivatives& result) {
  const ConfigurationCost configuration = configuration_cost(cost.q_ref, cost.configuration_weight, point.q);
  result.gradient.head(nv_) += weight * configuration.gradient;
  result.gradient.segment(nv_, nv_) += weight * cost.velocity_weight.cwiseProduct(point.v);
  if (with_hessian) {
    result.hessian.diagonal().head(nv_) += weight * configuration.hessian_diagonal;
    result.hessian.block<3, 3>(3, 3) += weight * configuration.hessian_rotation;
    result.hessian.diagonal().segment(nv_, nv_) += weight * cost.velocity_weight;
  }
  if (cost.contact_positions.empty()) return;
  points.set_configuration(terms);
  Eigen::VectorXd pull(points.rows()), stiffness(points.rows());
  for (std::size_t i = 0; i < cost.contact_positions.size(); ++i) {
    const ContactPositionCost& place = cost.contact_positions[i];
    const auto row = static_cast<Eigen::Index>(3 * i);
    stiffness.segment<3>(row) = weight * place.weight;
    pull.segment<3>(row) =
        stiffness.segment<3>(row).cwiseProduct(points.positions().segment<3>(row) - place.reference);
  }
  result.gradient.head(nv_) += points.positions_dq().transpose() * pull;
  if (!with_hessian) return;
  Eigen::MatrixXd bend = points.positions_dq().transpose() * stiffness.asDiagonal() * points.positions_dq();
  points.add_position_hessian(pull, 1.0, bend);
  result.hessian.topLeftCorner(nv_, nv_) += bend;
}

void NodeCost::derivatives(const NodePoint& point, const RigidBodyTerms& terms, const Eigen::VectorXd& forces,
                           bool with_hessian, Derivatives& result) {
  const int size = 3 * nv_ + nu_;
  result.gradient.setZero(size);
  result.force_gradient.setZero(forces.size());
  result.hessian.setZero(with_hessian ? size : 0, with_hessian ? size : 0);
  if (point.cost_weight > 0.0) {
    const double weight = point.cost_weight;
    add_state_cost(running_, running_points_, weight, point, terms, with_hessian, result);
    result.gradient.segment(2 * nv_, nv_) += weight * running_.acceleration_weight.cwiseProduct(point.a);
    result.gradient.tail(nu_) += weight * running_.torque_weight.cwiseProduct(point.tau - running_.tau_ref);
    for (Eigen::Index row = 0; row < forces.size(); row += 3) {
      result.force_gradient.segment<3>(row) = force_curvature(point).cwiseProduct(forces.segment<3>(row));
    }
    if (with_hessian) {
      result.hessian.diagonal().segment(2 * nv_, nv_) += weight * running_.acceleration_weight;
      result.hessian.diagonal().tail(nu_) += weight * running_.torque_weight;
    }
  }
  result.running_gradient = result.gradient;
  if (point.terminal_weight > 0.0) {
    add_state_cost(terminal_, terminal_points_, point.terminal_weight, point, terms, with_hessian, result);
  }
}

}  // namespace prowl

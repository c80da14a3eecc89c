#include "prowl/transcription/transcription.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/defects.hpp"
#include "prowl/transcription/transcription_bounds.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::Vector3d;

/// Places of the start's contacts: a contact that holds stays there.
Eigen::VectorXd contact_anchors(const MotionProblem& problem, const Phase& phase) {
  RigidBodyTerms terms(problem.robot);
  terms.update_kinematics(problem.start_configuration());
  Eigen::VectorXd anchors(3 * static_cast<Index>(phase.contacts.size()));
  for (std::size_t i = 0; i < phase.contacts.size(); ++i) {
    anchors.segment<3>(static_cast<Index>(3 * i)) = terms.contact_position(phase.contacts[i].contact);
  }
  return anchors;
}

std::vector<int> contacts_per_phase(const MotionProblem& problem) {
  std::vector<int> counts;
  for (const Phase& phase : problem.phases) counts.push_back(static_cast<int>(phase.contacts.size()));
  return counts;
}

/// Base of node k, where z_q are the node's configuration variables.
BaseState base_state(const Eigen::VectorXd& z, const DecisionLayout& layout, const Eigen::Matrix3d& chart, int k) {
  return {chart, z.segment<3>(layout.q(k)), z.segment<3>(layout.q(k) + 3), z.segment<3>(layout.v(k)),
          z.segment<3>(layout.v(k) + 3)};
}

}  // namespace

Transcription::Transcription(const MotionProblem& problem, const Mesh& mesh, const Trajectory& guess)
    : problem_(problem),
      mesh_(mesh),
      layout_(mesh, problem.robot.nv(), contacts_per_phase(problem)),
      charts_(rotation_charts(problem, mesh, guess)) {
  refuse_what_is_not_supported(problem);
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const Phase& phase = problem.phases[p];
    const double step = mesh_.nodes[static_cast<std::size_t>(mesh_.index({static_cast<int>(p), 0}))].h_out;
    phases_.emplace_back(problem, phase, contact_anchors(problem, phase), step);
  }
  const VariableBounds bounds = variable_bounds(problem, mesh, layout_);
  variable_lower_ = bounds.lower;
  variable_upper_ = bounds.upper;
  constraint_lower_.setZero(num_constraints());
  constraint_upper_.setZero(num_constraints());
  for (int k = 0; k < layout_.num_nodes(); ++k) {  // friction cones: g >= 0
    constraint_upper_.segment(layout_.friction_row(k), layout_.friction_count(k)).setConstant(
        std::numeric_limits<double>::infinity());
  }
  values_.resize(static_cast<std::size_t>(layout_.num_nodes()));
  set_patterns();

  evaluate_nodes(pack(guess), false);
  for (std::size_t p = 0; p < phases_.size(); ++p) {
    if (phases_[p].contacts_are_independent()) continue;
    throw InputError(fmt::format(
        "phase '{}': its {} contact points are not independent (the contact Jacobian loses rank at the initial guess); "
        "planning with redundant contacts is not supported yet: list fewer contact points",
        problem.phases[p].name, problem.phases[p].contacts.size()));
  }
}

bool Transcription::is_interval(int k) const { return step(k) > 0.0; }

NodePoint Transcription::node_point(const Eigen::VectorXd& z, int k) const {
  const int nv = layout_.nv(), nu = layout_.nu();
  const MeshNode& node = mesh_.nodes[static_cast<std::size_t>(k)];
  NodePoint point;
  point.theta = z.segment<3>(layout_.q(k) + 3);
  point.q.resize(nv + 1);
  point.q.head<3>() = z.segment<3>(layout_.q(k));
  set_base_rotation(point.q, charts_[static_cast<std::size_t>(k)] * so3::exp(point.theta));
  point.q.tail(nu) = z.segment(layout_.q(k) + 6, nu);
  point.v = z.segment(layout_.v(k), nv);
  point.a = z.segment(layout_.a(k), nv);
  point.tau = z.segment(layout_.tau(k), nu);
  point.cost_weight = 0.5 * (node.h_in + node.h_out);
  point.terminal_weight = k + 1 == layout_.num_nodes() ? 1.0 : 0.0;
  return point;
}

void Transcription::evaluate_nodes(const Eigen::VectorXd& z, bool with_derivatives) {
  if (evaluated_at_.size() == z.size() && evaluated_at_ == z && (have_derivatives_ || !with_derivatives)) return;
  evaluated_at_.resize(0);  // in case that an evaluation throws half-way
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    NodeFunctions& functions = phases_[static_cast<std::size_t>(mesh_.nodes[static_cast<std::size_t>(k)].phase)];
    NodeValues& values = values_[static_cast<std::size_t>(k)];
    try {
      const NodePoint point = node_point(z, k);
      with_derivatives ? functions.evaluate_with_derivatives(point, values) : functions.evaluate(point, values);
    } catch (const NumericalError& error) {
      throw NumericalError(fmt::format("{}, t = {:.3f} s: {}", describe_node(k), mesh_.nodes[static_cast<std::size_t>(k)].time,
                                       error.what()));
    }
  }
  evaluated_at_ = z;
  have_derivatives_ = with_derivatives;
}

double Transcription::cost(const Eigen::VectorXd& z) {
  evaluate_nodes(z, false);
  double total = 0.0;
  for (const NodeValues& values : values_) total += values.cost;
  return total;
}

void Transcription::cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) {
  evaluate_nodes(z, true);
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    gradient.segment(layout_.node(k), layout_.node_size()) = values_[static_cast<std::size_t>(k)].cost_gradient;
  }
}

void Transcription::constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) {
  evaluate_nodes(z, false);
  const int nv = layout_.nv(), nu = layout_.nu();
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const Eigen::VectorXd& rows = values_[static_cast<std::size_t>(k)].rows;
    g.segment(layout_.dynamics_row(k), rows.size()) = rows;
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    const double half = 0.5 * step(k);
    const int row = layout_.link_row(k);
    g.segment(row, nv) = z.segment(layout_.q(k + 1), nv) - z.segment(layout_.q(k), nv);
    g.segment(row + nv, nv) = z.segment(layout_.v(k + 1), nv) - z.segment(layout_.v(k), nv) -
                              half * (z.segment(layout_.a(k), nv) + z.segment(layout_.a(k + 1), nv));
    if (!is_interval(k)) continue;  // both nodes of a phase switch have one chart: the difference is the condition
    const BaseDefects base(base_state(z, layout_, charts_[static_cast<std::size_t>(k)], k),
                           base_state(z, layout_, charts_[static_cast<std::size_t>(k + 1)], k + 1), step(k));
    g.segment<3>(row) = base.position();
    g.segment<3>(row + 3) = base.rotation();
    g.segment(row + 6, nu) -= half * (z.segment(layout_.v(k) + 6, nu) + z.segment(layout_.v(k + 1) + 6, nu));
  }
}

/// Calls emit(row, col, value) for each non-zero of the Jacobian, always in the same order. Without derivatives (z empty)
/// the values mean nothing and only the places count.
template <class Emit>
void Transcription::visit_jacobian(const Eigen::VectorXd& z, Emit emit) const {
  const int nv = layout_.nv(), nu = layout_.nu();
  const bool pattern_only = z.size() == 0;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const Eigen::MatrixXd& rows = values_[static_cast<std::size_t>(k)].rows_jacobian;
    for (int i = 0; i < nv + layout_.friction_count(k); ++i) {
      for (int j = 0; j < layout_.node_size(); ++j) {
        emit(layout_.dynamics_row(k) + i, layout_.node(k) + j, pattern_only ? 0.0 : rows(i, j));
      }
    }
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    const int row = layout_.link_row(k);
    const double half = 0.5 * step(k);
    for (int i = 0; i < nv; ++i) {
      emit(row + nv + i, layout_.v(k) + i, -1.0);
      emit(row + nv + i, layout_.v(k + 1) + i, 1.0);
      if (is_interval(k)) {
        emit(row + nv + i, layout_.a(k) + i, -half);
        emit(row + nv + i, layout_.a(k + 1) + i, -half);
      }
    }
    if (!is_interval(k)) {
      for (int i = 0; i < nv; ++i) {
        emit(row + i, layout_.q(k) + i, -1.0);
        emit(row + i, layout_.q(k + 1) + i, 1.0);
      }
      continue;
    }
    for (int i = 0; i < nu; ++i) {
      emit(row + 6 + i, layout_.q(k) + 6 + i, -1.0);
      emit(row + 6 + i, layout_.q(k + 1) + 6 + i, 1.0);
      emit(row + 6 + i, layout_.v(k) + 6 + i, -half);
      emit(row + 6 + i, layout_.v(k + 1) + 6 + i, -half);
    }
    BaseDefects::Matrix3x12 rotation = BaseDefects::Matrix3x12::Zero();
    if (!pattern_only) {
      rotation = BaseDefects(base_state(z, layout_, charts_[static_cast<std::size_t>(k)], k),
                             base_state(z, layout_, charts_[static_cast<std::size_t>(k + 1)], k + 1), step(k))
                     .rotation_derivative();
    }
    for (const int end : {k, k + 1}) {
      Eigen::Matrix3d d_theta = Eigen::Matrix3d::Zero(), d_v = Eigen::Matrix3d::Zero();
      if (!pattern_only) {
        const WorldVelocity velocity(charts_[static_cast<std::size_t>(end)], z.segment<3>(layout_.q(end) + 3),
                                     z.segment<3>(layout_.v(end)));
        d_theta = velocity.d_theta;
        d_v = velocity.d_v;
      }
      const int first = end == k ? 0 : 6;
      for (int i = 0; i < 3; ++i) {
        emit(row + i, layout_.q(end) + i, end == k ? -1.0 : 1.0);
        for (int j = 0; j < 3; ++j) {
          emit(row + i, layout_.q(end) + 3 + j, -half * d_theta(i, j));
          emit(row + i, layout_.v(end) + j, -half * d_v(i, j));
          emit(row + 3 + i, layout_.q(end) + 3 + j, rotation(i, first + j));
          emit(row + 3 + i, layout_.v(end) + 3 + j, rotation(i, first + 3 + j));
        }
      }
    }
  }
}

void Transcription::set_patterns() {
  const auto add = [](SparsityPattern& pattern) {
    return [&pattern](int row, int col, double) {
      pattern.rows.push_back(row);
      pattern.cols.push_back(col);
    };
  };
  visit_jacobian(Eigen::VectorXd(), add(jacobian_pattern_));
  const auto size = static_cast<Index>(layout_.node_size());
  const std::vector<Eigen::MatrixXd> nodes(static_cast<std::size_t>(layout_.num_nodes()), Eigen::MatrixXd(size, size));
  const std::vector<Eigen::Matrix<double, 6, 6>> links(static_cast<std::size_t>(layout_.num_links()));
  visit_hessian(nodes, links, add(hessian_pattern_));
}

void Transcription::jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) {
  evaluate_nodes(z, true);
  Index next = 0;
  visit_jacobian(z, [&](int, int, double value) { values(next++) = value; });
}

/// As visit_jacobian, for the lower triangle of the Hessian: a dense block a node, and over each interval the block of
/// (theta, angular velocity) at its end with those at its start.
template <class Emit>
void Transcription::visit_hessian(const std::vector<Eigen::MatrixXd>& nodes,
                                  const std::vector<Eigen::Matrix<double, 6, 6>>& links, Emit emit) const {
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    for (int j = 0; j < layout_.node_size(); ++j) {
      for (int i = j; i < layout_.node_size(); ++i) {
        emit(layout_.node(k) + i, layout_.node(k) + j, nodes[static_cast<std::size_t>(k)](i, j));
      }
    }
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (!is_interval(k)) continue;
    const auto column = [&](int node, int i) { return i < 3 ? layout_.q(node) + 3 + i : layout_.v(node) + i; };
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) emit(column(k + 1, i), column(k, j), links[static_cast<std::size_t>(k)](i, j));
    }
  }
}

void Transcription::hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
                            Eigen::Ref<Eigen::VectorXd> values) {
  std::vector<Eigen::MatrixXd> nodes(static_cast<std::size_t>(layout_.num_nodes()));
  std::vector<Eigen::Matrix<double, 6, 6>> links(static_cast<std::size_t>(layout_.num_links()));
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    NodeFunctions& functions = phases_[static_cast<std::size_t>(mesh_.nodes[static_cast<std::size_t>(k)].phase)];
    functions.hessian(node_point(z, k), cost_factor,
                      multipliers.segment(layout_.dynamics_row(k), functions.num_rows()),
                      nodes[static_cast<std::size_t>(k)]);
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (is_interval(k)) add_defect_hessian(z, multipliers, k, nodes, links[static_cast<std::size_t>(k)]);
  }
  Index next = 0;
  visit_hessian(nodes, links, [&](int, int, double value) { values(next++) = value; });
}

/// Adds what bends in the defects of the base over the interval from node k.
void Transcription::add_defect_hessian(const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers, int k,
                                       std::vector<Eigen::MatrixXd>& nodes, Eigen::Matrix<double, 6, 6>& link) const {
  const int row = layout_.link_row(k);
  const BaseDefects base(base_state(z, layout_, charts_[static_cast<std::size_t>(k)], k),
                         base_state(z, layout_, charts_[static_cast<std::size_t>(k + 1)], k + 1), step(k));
  const BaseDefects::Matrix12 rotation = base.rotation_hessian(multipliers.segment<3>(row + 3));
  link = rotation.bottomLeftCorner<6, 6>();
  const Vector3d pull = -0.5 * step(k) * multipliers.segment<3>(row);
  const int theta = 3, v = layout_.nv(), w = layout_.nv() + 3;
  for (const int end : {k, k + 1}) {
    const int first = end == k ? 0 : 6;
    Eigen::MatrixXd& node = nodes[static_cast<std::size_t>(end)];
    const WorldVelocityHessian velocity(charts_[static_cast<std::size_t>(end)], z.segment<3>(layout_.q(end) + 3),
                                        z.segment<3>(layout_.v(end)), pull);
    node.block<3, 3>(theta, theta) += velocity.theta_theta + rotation.block<3, 3>(first, first);
    node.block<3, 3>(theta, v) += velocity.theta_v;
    node.block<3, 3>(v, theta) += velocity.theta_v.transpose();
    node.block<3, 3>(theta, w) += rotation.block<3, 3>(first, first + 3);
    node.block<3, 3>(w, theta) += rotation.block<3, 3>(first + 3, first);
    node.block<3, 3>(w, w) += rotation.block<3, 3>(first + 3, first + 3);
  }
}

Eigen::VectorXd Transcription::pack(const Trajectory& trajectory) const {
  Eigen::VectorXd z(num_variables());
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const TrajectoryPoint& point = trajectory.nodes[static_cast<std::size_t>(k)];
    z.segment<3>(layout_.q(k)) = base_position(point.q);
    z.segment<3>(layout_.q(k) + 3) =
        so3::log(charts_[static_cast<std::size_t>(k)].transpose() * base_rotation(point.q));
    z.segment(layout_.q(k) + 6, layout_.nu()) = point.q.tail(layout_.nu());
    z.segment(layout_.v(k), layout_.nv()) = point.v;
    z.segment(layout_.a(k), layout_.nv()) = point.a;
    z.segment(layout_.tau(k), layout_.nu()) = point.tau;
  }
  return z;
}

Trajectory Transcription::unpack(const Eigen::VectorXd& z) {
  evaluate_nodes(z, false);
  Trajectory trajectory;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const MeshNode& node = mesh_.nodes[static_cast<std::size_t>(k)];
    NodePoint from = node_point(z, k);
    TrajectoryPoint point;
    point.time = node.time;
    point.phase = node.phase;
    point.q = std::move(from.q);
    point.v = std::move(from.v);
    point.a = std::move(from.a);
    point.tau = std::move(from.tau);
    point.force.setZero(3 * static_cast<Index>(problem_.robot.contacts().size()));
    const std::vector<int>& contacts = phases_[static_cast<std::size_t>(node.phase)].contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      point.force.segment<3>(3 * contacts[i]) =
          values_[static_cast<std::size_t>(k)].forces.segment<3>(static_cast<Index>(3 * i));
    }
    trajectory.nodes.push_back(std::move(point));
  }
  return trajectory;
}

}  // namespace prowl

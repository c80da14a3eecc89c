#include "prowl/transcription/transcription.hpp"

#include <fmt/format.h>

#include <set>

#include "prowl/error.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/phase_setup.hpp"
#include "prowl/transcription/stagewise_transcription.hpp"
#include "prowl/transcription/transcription_bounds.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

std::vector<NodeFunctions> functions_of_phases(const MotionProblem& problem, const ContactSchedule& schedule,
                                               const std::vector<PhaseContacts>& contacts) {
  std::vector<NodeFunctions> functions;
  for (std::size_t p = 0; p < contacts.size(); ++p) {
    functions.emplace_back(problem, schedule, static_cast<int>(p), contacts[p]);
  }
  return functions;
}

std::vector<std::vector<NodeFunctions>> first_thread(std::vector<NodeFunctions> functions) {
  std::vector<std::vector<NodeFunctions>> threads;
  threads.push_back(std::move(functions));
  return threads;
}

std::vector<int> sizes_of_w(const std::vector<NodeFunctions>& phases) {
  std::vector<int> sizes;
  for (const NodeFunctions& phase : phases) sizes.push_back(static_cast<int>(phase.chosen_rows().size()));
  return sizes;
}

std::vector<int> rows_of_nodes(const std::vector<NodeFunctions>& phases, const Mesh& mesh) {
  std::vector<int> rows;
  for (const MeshNode& node : mesh.nodes) rows.push_back(phases[node.phase].num_rows(node.node));
  return rows;
}

}  // namespace

Transcription::Transcription(const MotionProblem& problem, const Mesh& mesh, const Trajectory& guess)
    : problem_(problem),
      schedule_(problem),
      mesh_(mesh),
      contacts_(contacts_of_phases(problem, schedule_, mesh, guess)),
      phases_(first_thread(functions_of_phases(problem, schedule_, contacts_))),
      anchor_origins_(anchor_origins(problem, schedule_)),
      layout_(problem, schedule_, mesh, sizes_of_w(phases_.front()), rows_of_nodes(phases_.front(), mesh)),
      charts_(rotation_charts(problem, mesh, guess)) {
  std::set<std::pair<int, int>> pairs;
  for (int p = 0; p < static_cast<int>(problem_.phases.size()); ++p) {
    std::vector<int>& shared = shared_.emplace_back();
    if (layout_.duration(p) >= 0) shared.push_back(layout_.duration(p));
    for (const int i : phases_.front()[p].landed()) {
      const int place = layout_.place(schedule_.stance(p, i));
      shared.insert(shared.end(), {place, place + 1});
    }
    for (const int row : shared) {
      for (const int col : shared) {
        if (row >= col) pairs.insert({row - layout_.first_shared(), col - layout_.first_shared()});
      }
    }
  }
  shared_pairs_.assign(pairs.begin(), pairs.end());

  const VariableBounds bounds = variable_bounds(problem, schedule_, mesh, layout_);
  variable_lower_ = bounds.lower;
  variable_upper_ = bounds.upper;
  constraint_lower_.setZero(layout_.num_constraints());
  constraint_upper_.setZero(layout_.num_constraints());
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const int node = mesh_node(k).node;
    for (int row = 0; row < functions(k).num_rows(node); ++row) {
      constraint_lower_(layout_.node_row(k) + row) = functions(k).lower(node, row);
      constraint_upper_(layout_.node_row(k) + row) = functions(k).upper(node, row);
    }
  }
  values_.resize(static_cast<std::size_t>(layout_.num_nodes()));
  set_patterns();
}

Transcription::~Transcription() = default;

StagewiseNlp* Transcription::stagewise() {
  if (!stagewise_) {
    stagewise_ = std::make_unique<StagewiseTranscription>(*this);
    stagewise_->use_threads(threads_.count());
  }
  return stagewise_.get();
}

int Transcription::use_threads(int count) {
  count = std::min(count, layout_.num_nodes());  // more would have nothing to do
  const HessianKind hessian = phases_.front().front().hessian_kind();
  phases_.resize(static_cast<std::size_t>(std::min(count, static_cast<int>(phases_.size()))));
  while (static_cast<int>(phases_.size()) < count) {
    phases_.push_back(functions_of_phases(problem_, schedule_, contacts_));
  }
  use_hessian(hessian);
  if (stagewise_) stagewise_->use_threads(count);
  threads_ = ThreadTeam(count);
  return count;
}

void Transcription::use_hessian(HessianKind kind) {
  for (std::vector<NodeFunctions>& phases : phases_) {
    for (NodeFunctions& functions : phases) functions.use_hessian(kind);
  }
}

double Transcription::duration(const VectorXd& z, int phase) const {
  const int index = layout_.duration(phase);
  return index >= 0 ? z(index) : problem_.phases[phase].duration.min;
}

double Transcription::step(const VectorXd& z, int k) const {
  const int phase = phase_of(k);
  return problem_.phases[phase].step(mesh_node(k).node, duration(z, phase));
}

double Transcription::step_per_duration(int k) const {
  return problem_.phases[phase_of(k)].step(mesh_node(k).node, 1.0);
}

NodePoint Transcription::node_point(const VectorXd& z, int k) const {
  VectorXd node(functions(k).num_columns());
  for (Index j = 0; j < node.size(); ++j) node(j) = z(column(k, static_cast<int>(j)));
  NodePoint point;
  set_point(k, node, point);
  return point;
}

void Transcription::set_point(int k, const VectorXd& node, NodePoint& point) const {
  const int nv = layout_.nv(), nu = layout_.nu();
  const MeshNode& mesh_node = this->mesh_node(k);
  const auto phase = static_cast<std::size_t>(mesh_node.phase);
  const Phase& asked = problem_.phases[phase];
  point.node = mesh_node.node;
  point.theta = node.segment<3>(3);
  point.q.resize(nv + 1);
  point.q.head<3>() = node.head<3>();
  set_base_rotation(point.q, charts_[k] * so3::exp(point.theta));
  point.q.tail(nu) = node.segment(6, nu);
  point.v = node.segment(nv, nv);
  point.a = node.segment(2 * nv, nv);
  point.tau = node.segment(3 * nv, nu);
  point.w = node.segment(3 * nv + nu, layout_.num_w(k));
  Index shared = layout_.node_size(k);
  point.duration = functions(k).has_free_duration() ? node(shared++) : asked.duration.min;
  point.anchors = anchor_origins_[phase];
  for (const int i : functions(k).landed()) {
    const int surface = asked.contacts[i].surface;
    point.anchors.segment<3>(3 * i) += problem_.surfaces[surface].axes() * node.segment<2>(shared);
    shared += 2;
  }
  const double step_in = mesh_node.h_in > 0.0 ? asked.step(point.node - 1, point.duration) : 0.0;
  const double step_out = mesh_node.h_out > 0.0 ? asked.step(point.node, point.duration) : 0.0;
  point.cost_weight = 0.5 * (step_in + step_out);
  point.terminal_weight = k + 1 == layout_.num_nodes() ? 1.0 : 0.0;
}

IntervalEnd Transcription::interval_end(const VectorXd& z, int k) const {
  const int nv = layout_.nv();
  return {charts_[k], z.segment(layout_.q(k), nv), z.segment(layout_.v(k), nv), z.segment(layout_.a(k), nv)};
}

IntervalDefects Transcription::interval(const VectorXd& z, int k) const {
  return {interval_end(z, k), interval_end(z, k + 1), step(z, k)};
}

void Transcription::evaluate_nodes(const VectorXd& z, bool with_derivatives) {
  if (evaluated_at_.size() == z.size() && evaluated_at_ == z && (have_derivatives_ || !with_derivatives)) return;
  evaluated_at_.resize(0);  // in case that an evaluation throws half-way
  threads_.for_each(layout_.num_nodes(), [&](int k) {
    NodeValues& values = values_[k];
    at_node(k, [&] {
      const NodePoint point = node_point(z, k);
      with_derivatives ? functions(k).evaluate_with_derivatives(point, values) : functions(k).evaluate(point, values);
    });
  });
  evaluated_at_ = z;
  have_derivatives_ = with_derivatives;
}

double Transcription::cost(const VectorXd& z) {
  evaluate_nodes(z, false);
  double total = 0.0;
  for (const NodeValues& values : values_) total += values.cost;
  return total;
}

void Transcription::cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) {
  evaluate_nodes(z, true);
  gradient.setZero();
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const VectorXd& slope = values_[k].cost_gradient;
    for (int j = 0; j < functions(k).num_columns(); ++j) gradient(column(k, j)) += slope(j);
  }
}

void Transcription::constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) {
  evaluate_nodes(z, false);
  const int nv = layout_.nv();
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const VectorXd& rows = values_[k].rows;
    g.segment(layout_.node_row(k), rows.size()) = rows;
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (is_interval(k)) {
      g.segment(layout_.link_row(k), 2 * nv) = interval(z, k).value();
    } else {  // both nodes of a phase switch have one chart: the difference is the condition
      g.segment(layout_.link_row(k), 2 * nv) = z.segment(layout_.q(k + 1), 2 * nv) - z.segment(layout_.q(k), 2 * nv);
    }
  }
}

int Transcription::column(int k, int j) const {
  const int own = layout_.node_size(k);
  return j < own ? layout_.node(k) + j : shared_[phase_of(k)][j - own];
}

/// Calls emit(row, col, value) for each non-zero of the Jacobian, always in the same order. Without derivatives (z
/// empty) the values mean nothing and only the places count.
template <class Emit>
void Transcription::visit_jacobian(const VectorXd& z, Emit emit) const {
  const int nv = layout_.nv(), nu = layout_.nu();
  const bool pattern_only = z.size() == 0;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const MatrixXd& rows = values_[k].rows_jacobian;
    for (int i = 0; i < functions(k).num_rows(mesh_node(k).node); ++i) {
      for (int j = 0; j < functions(k).num_columns(); ++j) {
        emit(layout_.node_row(k) + i, column(k, j), pattern_only ? 0.0 : rows(i, j));
      }
    }
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    const int row = layout_.link_row(k);
    if (!is_interval(k)) {
      for (int i = 0; i < 2 * nv; ++i) {
        emit(row + i, layout_.q(k) + i, -1.0);
        emit(row + i, layout_.q(k + 1) + i, 1.0);
      }
      continue;
    }
    const int free_duration = layout_.duration(phase_of(k));
    double half = 0.0;
    BaseDefects::Matrix3x12 rotation = BaseDefects::Matrix3x12::Zero();
    Eigen::Matrix3d d_theta[2], d_v[2];
    VectorXd d_duration = VectorXd::Zero(2 * nv);
    if (!pattern_only) {
      const IntervalDefects defects = interval(z, k);
      half = 0.5 * step(z, k);
      rotation = defects.rotation_derivative();
      for (const int end : {0, 1}) {
        d_theta[end] = defects.position_dtheta(end);
        d_v[end] = defects.position_dv(end);
      }
      if (free_duration >= 0) d_duration = step_per_duration(k) * defects.d_step();
    }
    for (const int end : {0, 1}) {
      const int node = k + end;
      const double sign = end == 0 ? -1.0 : 1.0;
      for (int i = 0; i < 3; ++i) {
        emit(row + i, layout_.q(node) + i, sign);
        for (int j = 0; j < 3; ++j) {
          emit(row + i, layout_.q(node) + 3 + j, d_theta[end](i, j));
          emit(row + i, layout_.v(node) + j, d_v[end](i, j));
          emit(row + 3 + i, layout_.q(node) + 3 + j, rotation(i, 6 * end + j));
          emit(row + 3 + i, layout_.v(node) + 3 + j, rotation(i, 6 * end + 3 + j));
        }
      }
      for (int i = 6; i < 6 + nu; ++i) {
        emit(row + i, layout_.q(node) + i, sign);
        emit(row + i, layout_.v(node) + i, -half);
      }
      for (int i = 0; i < nv; ++i) {
        emit(row + nv + i, layout_.v(node) + i, sign);
        emit(row + nv + i, layout_.a(node) + i, -half);
      }
    }
    if (free_duration < 0) continue;
    for (int i = 0; i < 2 * nv; ++i) emit(row + i, free_duration, d_duration(i));
  }
}

void Transcription::set_patterns() {
  const auto add = [](SparsityPattern& pattern) {
    return [&pattern](int row, int col, double) {
      pattern.rows.push_back(row);
      pattern.cols.push_back(col);
    };
  };
  visit_jacobian(VectorXd(), add(jacobian_pattern_));
  std::vector<MatrixXd> nodes;
  for (int k = 0; k < layout_.num_nodes(); ++k)
    nodes.emplace_back(functions(k).num_columns(), functions(k).num_columns());
  const std::vector<Eigen::Matrix<double, 6, 6>> links(static_cast<std::size_t>(layout_.num_links()));
  const int num_shared = num_variables() - layout_.first_shared();
  visit_hessian(nodes, links, MatrixXd(num_shared, num_shared), add(hessian_pattern_));
}

void Transcription::jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) {
  evaluate_nodes(z, true);
  Index next = 0;
  visit_jacobian(z, [&](int, int, double value) { values(next++) = value; });
}

/// As visit_jacobian, for the lower triangle of the Hessian: a dense block a node, over each interval the block of
/// (theta, angular velocity) at its end with those at its start, each node with what its phase shares, and what is
/// shared by itself.
template <class Emit>
void Transcription::visit_hessian(const std::vector<MatrixXd>& nodes,
                                  const std::vector<Eigen::Matrix<double, 6, 6>>& links, const MatrixXd& shared,
                                  Emit emit) const {
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const MatrixXd& node = nodes[k];
    for (int j = 0; j < layout_.node_size(k); ++j) {
      for (int i = j; i < static_cast<int>(node.rows()); ++i) emit(column(k, i), column(k, j), node(i, j));
    }
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (!is_interval(k)) continue;
    const auto turning = [&](int node, int i) { return i < 3 ? layout_.q(node) + 3 + i : layout_.v(node) + i; };
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) emit(turning(k + 1, i), turning(k, j), links[k](i, j));
    }
  }
  for (const auto& [row, col] : shared_pairs_) {
    emit(layout_.first_shared() + row, layout_.first_shared() + col, shared(row, col));
  }
}

void Transcription::hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
                            Eigen::Ref<VectorXd> values) {
  const int nv = layout_.nv();
  const int num_shared = num_variables() - layout_.first_shared();
  std::vector<MatrixXd> nodes(static_cast<std::size_t>(layout_.num_nodes()));
  std::vector<Eigen::Matrix<double, 6, 6>> links(static_cast<std::size_t>(layout_.num_links()),
                                                 Eigen::Matrix<double, 6, 6>::Zero());
  MatrixXd shared = MatrixXd::Zero(num_shared, num_shared);
  threads_.for_each(layout_.num_nodes(), [&](int k) {
    at_node(k, [&] {
      functions(k).hessian(node_point(z, k), cost_factor,
                           multipliers.segment(layout_.node_row(k), functions(k).num_rows(mesh_node(k).node)),
                           nodes[k]);
    });
  });
  const bool is_exact = phases_.front().front().hessian_kind() == HessianKind::exact;
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (!is_interval(k) || !is_exact) continue;
    const IntervalDefects::Hessian bent = interval(z, k).hessian(multipliers.segment(layout_.link_row(k), 2 * nv));
    links[k] = bent.link;
    const int free_duration = layout_.duration(phase_of(k));
    const double per_duration = step_per_duration(k);
    for (const int end : {0, 1}) {
      MatrixXd& node = nodes[k + end];
      node.block<3, 3>(3, nv) += bent.theta_v[end];
      node.block<3, 3>(nv, 3) += bent.theta_v[end].transpose();
      const auto place = [&](int i) { return i < 3 ? 3 + i : nv + i; };
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) node(place(i), place(j)) += bent.turn[end](i, j);
      }
      if (free_duration < 0) continue;
      node.row(layout_.node_size(k + end)).head(3 * nv) += per_duration * bent.step[end].transpose();
    }
    if (free_duration < 0) continue;
    const int d = free_duration - layout_.first_shared();
    shared(d, d) += per_duration * per_duration * bent.step_step;
  }
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const std::vector<int>& variables = shared_[phase_of(k)];
    const int own = layout_.node_size(k);
    for (std::size_t i = 0; i < variables.size(); ++i) {
      for (std::size_t j = 0; j < variables.size(); ++j) {
        const int row = variables[i] - layout_.first_shared(), col = variables[j] - layout_.first_shared();
        shared(row, col) += nodes[k](own + static_cast<int>(i), own + static_cast<int>(j));
      }
    }
  }
  Index next = 0;
  visit_hessian(nodes, links, shared, [&](int, int, double value) { values(next++) = value; });
}

VectorXd Transcription::pack(const Trajectory& trajectory) const {
  VectorXd z(num_variables());
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const TrajectoryPoint& point = trajectory.nodes[k];
    z.segment<3>(layout_.q(k)) = base_position(point.q);
    z.segment<3>(layout_.q(k) + 3) = so3::log(charts_[k].transpose() * base_rotation(point.q));
    z.segment(layout_.q(k) + 6, layout_.nu()) = point.q.tail(layout_.nu());
    z.segment(layout_.v(k), layout_.nv()) = point.v;
    z.segment(layout_.a(k), layout_.nv()) = point.a;
    z.segment(layout_.tau(k), layout_.nu()) = point.tau;
    const std::vector<int>& chosen = functions(k).chosen_rows();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const int contact = functions(k).contacts()[chosen[i] / 3];
      z(layout_.w(k) + static_cast<Index>(i)) = point.force(3 * contact + chosen[i] % 3);
    }
  }
  for (int p = 0; p < static_cast<int>(problem_.phases.size()); ++p) {
    if (layout_.duration(p) < 0) continue;
    const int last = problem_.phases[p].intervals;
    z(layout_.duration(p)) = trajectory.nodes[mesh_.index({p, last})].time - trajectory.nodes[mesh_.index({p, 0})].time;
  }
  RigidBodyTerms terms(problem_.robot);
  for (std::size_t s = 0; s < schedule_.stances().size(); ++s) {
    const Stance& stance = schedule_.stances()[s];
    if (!stance.lands()) continue;
    terms.update_kinematics(trajectory.nodes[mesh_.index({stance.first_phase, 0})].q);
    z.segment<2>(layout_.place(static_cast<int>(s))) =
        problem_.surfaces[stance.surface].coordinates(terms.contact_position(stance.contact));
  }
  return z;
}

Trajectory Transcription::unpack(const VectorXd& z) {
  evaluate_nodes(z, false);
  Trajectory trajectory;
  double phase_start = 0.0;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const MeshNode& node = mesh_node(k);
    const Phase& phase = problem_.phases[node.phase];
    NodePoint from = node_point(z, k);
    TrajectoryPoint point;
    point.time = phase_start + phase.node_time(node.node, from.duration);
    if (node.node == phase.intervals) phase_start = point.time;
    point.phase = node.phase;
    point.q = std::move(from.q);
    // Of the two quaternions of a rotation the one that goes on without a jump.
    if (k > 0 && point.q.segment<4>(3).dot(trajectory.nodes.back().q.segment<4>(3)) < 0.0)
      point.q.segment<4>(3) *= -1.0;
    point.v = std::move(from.v);
    point.a = std::move(from.a);
    point.tau = std::move(from.tau);
    point.force.setZero(3 * static_cast<Index>(problem_.robot.contacts().size()));
    const std::vector<int>& contacts = functions(k).contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      point.force.segment<3>(3 * contacts[i]) = values_[k].forces.segment<3>(static_cast<Index>(3 * i));
    }
    trajectory.nodes.push_back(std::move(point));
  }
  return trajectory;
}

}  // namespace prowl

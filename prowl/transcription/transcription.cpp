#include "prowl/transcription/transcription.hpp"

#include <algorithm>
#include <set>

#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/transcription/describe_program.hpp"
#include "prowl/transcription/stagewise_transcription.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

Transcription::Transcription(const DiscreteProblem& discrete, const Trajectory& guess, Corrections corrections)
    : MotionNlp(discrete), nodes_(discrete, guess, std::move(corrections)), layout_(nodes_.layout()) {
  variable_lower_ = nodes_.bounds().lower;
  variable_upper_ = nodes_.bounds().upper;
  values_.resize(nodes_.num_nodes());
  set_shared_pairs();
  set_rows();
  set_patterns();
}

Transcription::~Transcription() = default;

void Transcription::set_shared_pairs() {
  std::set<std::pair<int, int>> pairs;
  for (int p = 0; p < static_cast<int>(problem().phases.size()); ++p) {
    for (const int row : nodes_.shared(p)) {
      for (const int col : nodes_.shared(p)) {
        if (row >= col) pairs.insert({row - layout_.first_shared(), col - layout_.first_shared()});
      }
    }
  }
  shared_pairs_.assign(pairs.begin(), pairs.end());
}

void Transcription::set_rows() {
  constraint_lower_.setZero(layout_.num_constraints());
  constraint_upper_.setZero(layout_.num_constraints());
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const int node = mesh_node(k).node;
    for (int row = 0; row < nodes_.num_rows(k); ++row) {
      constraint_lower_(layout_.node_row(k) + row) = nodes_.functions(k).lower(node, row);
      constraint_upper_(layout_.node_row(k) + row) = nodes_.functions(k).upper(node, row);
    }
  }
}

StagewiseNlp* Transcription::stagewise() {
  if (!stagewise_) {
    stagewise_ = std::make_unique<StagewiseTranscription>(nodes_);
    stagewise_->use_threads(threads_.count());
  }
  return stagewise_.get();
}

int Transcription::use_threads(int count) {
  count = std::min(count, nodes_.num_nodes());  // more would idle
  nodes_.use_threads(count);
  if (stagewise_) stagewise_->use_threads(count);
  threads_ = ThreadTeam(count);
  return count;
}

void Transcription::use_hessian(HessianKind kind) { nodes_.use_hessian(kind); }

std::string Transcription::describe_constraint(int row) const { return prowl::describe_constraint(nodes_, row); }

std::string Transcription::describe_variable(int index) const { return prowl::describe_variable(nodes_, index); }

double Transcription::step(const VectorXd& z, int k) const {
  const int phase = phase_of(k);
  return discrete_.mesh.phases[phase].step(mesh_node(k).node, duration(z, phase, layout_.duration(phase)));
}

double Transcription::step_per_duration(int k) const { return discrete_.phase_mesh_of(k).step(mesh_node(k).node, 1.0); }

NodePoint Transcription::node_point(const VectorXd& z, int k) const {
  NodePoint point;
  nodes_.set_point(k, nodes_.variables(k, z), point);
  return point;
}

IntervalEnd Transcription::interval_end(const VectorXd& z, int k) const {
  const int nv = layout_.nv();
  return {nodes_.chart(k), z.segment(layout_.q(k), nv), z.segment(layout_.v(k), nv), z.segment(layout_.a(k), nv)};
}

IntervalDefects Transcription::interval(const VectorXd& z, int k) const {
  return {interval_end(z, k), interval_end(z, k + 1), step(z, k), nodes_.correction(k + 1)};
}

void Transcription::evaluate_all(const VectorXd& z, bool with_derivatives) {
  threads_.for_each(nodes_.num_nodes(), [&](int k) {
    nodes_.at_node(k, [&] {
      const NodePoint point = node_point(z, k);
      NodeFunctions& functions = nodes_.functions(k);
      with_derivatives ? functions.evaluate_with_derivatives(point, values_[k]) : functions.evaluate(point, values_[k]);
    });
  });
}

double Transcription::cost(const VectorXd& z) {
  evaluate(z, false);
  double total = 0.0;
  for (const NodeValues& values : values_) total += values.cost;
  return total;
}

void Transcription::cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) {
  evaluate(z, true);
  gradient.setZero();
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const VectorXd& slope = values_[k].cost_gradient;
    for (int j = 0; j < nodes_.functions(k).num_columns(); ++j) gradient(nodes_.column(k, j)) += slope(j);
  }
}

void Transcription::constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) {
  evaluate(z, false);
  const int nv = layout_.nv();
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const VectorXd& rows = values_[k].rows;
    g.segment(layout_.node_row(k), rows.size()) = rows;
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (is_interval(k)) {
      g.segment(layout_.link_row(k), 2 * nv) = interval(z, k).value();
    } else {  // both nodes of a phase transition have one chart
      g.segment(layout_.link_row(k), 2 * nv) = z.segment(layout_.q(k + 1), 2 * nv) - z.segment(layout_.q(k), 2 * nv);
    }
  }
  if (!problem().cycle) return;
  auto closing = g.segment(layout_.closing_row(), 2 * nv);
  closing = z.segment(layout_.q(nodes_.num_nodes() - 1), 2 * nv) - z.segment(layout_.q(0), 2 * nv);
  closing.head<3>() =
      z.segment<3>(layout_.q(nodes_.num_nodes() - 1)) - problem().cycle->moved(z.segment<3>(layout_.q(0)));
}

/// Calls emit(row, col, value) for each non-zero of the Jacobian, in a fixed order. With empty z
/// the values are meaningless, for the pattern only.
template <class Emit>
void Transcription::visit_jacobian(const VectorXd& z, Emit emit) const {
  const int nv = layout_.nv(), nu = layout_.nu();
  const bool pattern_only = z.size() == 0;
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const MatrixXd& rows = values_[k].rows_jacobian;
    for (int i = 0; i < nodes_.num_rows(k); ++i) {
      for (int j = 0; j < nodes_.functions(k).num_columns(); ++j) {
        emit(layout_.node_row(k) + i, nodes_.column(k, j), pattern_only ? 0.0 : rows(i, j));
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
  if (!problem().cycle) return;
  const Eigen::Matrix3d moved = problem().cycle->rotation();
  for (int i = 0; i < 2 * nv; ++i) {
    emit(layout_.closing_row() + i, layout_.q(nodes_.num_nodes() - 1) + i, 1.0);
    if (i >= 3) emit(layout_.closing_row() + i, layout_.q(0) + i, -1.0);
    for (int j = 0; i < 3 && j < 3; ++j) emit(layout_.closing_row() + i, layout_.q(0) + j, -moved(i, j));
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
  for (int k = 0; k < nodes_.num_nodes(); ++k)
    nodes.emplace_back(nodes_.functions(k).num_columns(), nodes_.functions(k).num_columns());
  const std::vector<Eigen::Matrix<double, 6, 6>> links(static_cast<std::size_t>(layout_.num_links()));
  const int num_shared = num_variables() - layout_.first_shared();
  visit_hessian(nodes, links, MatrixXd(num_shared, num_shared), add(hessian_pattern_));
}

void Transcription::jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) {
  evaluate(z, true);
  Index next = 0;
  visit_jacobian(z, [&](int, int, double value) { values(next++) = value; });
}

/// Like visit_jacobian, for the lower triangle of the Hessian: a dense block per node, per interval
/// the block of (theta, angular velocity) at its end with those at its start, each node with its
/// shared variables, and these among themselves.
template <class Emit>
void Transcription::visit_hessian(const std::vector<MatrixXd>& nodes,
                                  const std::vector<Eigen::Matrix<double, 6, 6>>& links, const MatrixXd& shared,
                                  Emit emit) const {
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const MatrixXd& node = nodes[k];
    for (int j = 0; j < layout_.node_size(k); ++j) {
      for (int i = j; i < static_cast<int>(node.rows()); ++i)
        emit(nodes_.column(k, i), nodes_.column(k, j), node(i, j));
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
  std::vector<MatrixXd> nodes(static_cast<std::size_t>(nodes_.num_nodes()));
  std::vector<Eigen::Matrix<double, 6, 6>> links(static_cast<std::size_t>(layout_.num_links()),
                                                 Eigen::Matrix<double, 6, 6>::Zero());
  MatrixXd shared = MatrixXd::Zero(num_shared, num_shared);
  threads_.for_each(nodes_.num_nodes(), [&](int k) {
    nodes_.at_node(k, [&] {
      nodes_.functions(k).hessian(node_point(z, k), cost_factor,
                                  multipliers.segment(layout_.node_row(k), nodes_.num_rows(k)), nodes[k]);
    });
  });
  const bool is_exact = nodes_.hessian_kind() == HessianKind::exact;
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
      const auto index = [&](int i) { return i < 3 ? 3 + i : nv + i; };
      for (int i = 0; i < 6; ++i) {
        for (int j = 0; j < 6; ++j) node(index(i), index(j)) += bent.turn[end](i, j);
      }
      if (free_duration < 0) continue;
      node.row(layout_.node_size(k + end)).head(3 * nv) += per_duration * bent.step[end].transpose();
    }
    if (free_duration < 0) continue;
    const int d = free_duration - layout_.first_shared();
    shared(d, d) += per_duration * per_duration * bent.step_step;
  }
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const std::vector<int>& variables = nodes_.shared(phase_of(k));
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
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    const TrajectoryPoint& point = trajectory.nodes[k];
    z.segment<3>(layout_.q(k)) = base_position(point.q);
    z.segment<3>(layout_.q(k) + 3) = so3::log(nodes_.chart(k).transpose() * base_rotation(point.q));
    z.segment(layout_.q(k) + 6, layout_.nu()) = point.q.tail(layout_.nu());
    z.segment(layout_.v(k), layout_.nv()) = point.v;
    z.segment(layout_.a(k), layout_.nv()) = point.a;
    z.segment(layout_.tau(k), layout_.nu()) = point.tau;
    const std::vector<int>& chosen = nodes_.functions(k).chosen_rows();
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      const int contact = nodes_.functions(k).contacts()[chosen[i] / 3];
      z(layout_.w(k) + static_cast<Index>(i)) = point.force(3 * contact + chosen[i] % 3);
    }
  }
  for (int p = 0; p < static_cast<int>(problem().phases.size()); ++p) {
    if (layout_.duration(p) >= 0) z(layout_.duration(p)) = planned_duration(trajectory, p);
  }
  const std::vector<Eigen::Vector2d> footholds = landing_footholds(trajectory);
  for (int s = 0; s < static_cast<int>(footholds.size()); ++s) {
    if (layout_.foothold(s) >= 0) z.segment<2>(layout_.foothold(s)) = footholds[s];
  }
  return z;
}

Trajectory Transcription::unpack(const VectorXd& z) {
  evaluate(z, false);
  Trajectory trajectory;
  double phase_start = 0.0;
  for (int k = 0; k < nodes_.num_nodes(); ++k) {
    NodePoint from = node_point(z, k);
    TrajectoryPoint point;
    point.time = node_time(k, from.duration, phase_start);
    point.phase = phase_of(k);
    point.q = std::move(from.q);
    point.v = std::move(from.v);
    point.a = std::move(from.a);
    point.tau = std::move(from.tau);
    point.force.setZero(3 * static_cast<Index>(problem().robot.contacts().size()));
    const std::vector<int>& contacts = nodes_.functions(k).contacts();
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      point.force.segment<3>(3 * contacts[i]) = values_[k].forces.segment<3>(static_cast<Index>(3 * i));
    }
    append(std::move(point), trajectory);
  }
  if (nodes_.is_corrected()) trajectory.interpolation = Interpolation::hermite;
  return trajectory;
}

}  // namespace prowl

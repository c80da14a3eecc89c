#include "alternatives/centroidal/centroidal_nlp.hpp"

#include <utility>

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

double CentroidalNlp::share(int k) const { return 1.0 / discrete_.phase_mesh_of(k).intervals(); }

double CentroidalNlp::step(const VectorXd& z, int k) const {
  const int phase = phase_of(k);
  return share(k) * duration(z, phase, layout_.duration(phase));
}

CentroidalPoint CentroidalNlp::point(const VectorXd& z, int k) const {
  const double dt = step(z, k);
  return {.node = mesh_node(k).node,
          .x = z.segment(layout_.node(k), layout_.columns(k).size),
          .chart = charts_[k],
          .duration = dt / share(k),
          .cost_weight = layout_.columns(k).ends_interval() ? dt : 0.0,
          .terminal_weight = k + 1 == layout_.num_nodes() ? 1.0 : 0.0};
}

CentroidalInterval CentroidalNlp::interval(const VectorXd& z, int k) const {
  const auto end = [&](int i) -> CentroidalInterval::End {
    return {layout_.columns(i), charts_[i], z.segment(layout_.node(i), layout_.columns(i).size)};
  };
  return {scale_, node(k).contacts().sliding, acceleration_weight_, end(k), end(k + 1), step(z, k)};
}

void CentroidalNlp::evaluate_all(const VectorXd& z, bool with_derivatives) {
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    CentroidalValues& values = values_[k];
    const CentroidalPoint here = point(z, k);
    node(k).evaluate(here, values);
    if (with_derivatives) node(k).add_derivatives(here, values);
  }
}

double CentroidalNlp::cost(const VectorXd& z) {
  evaluate(z, false);
  double total = 0.0;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    total += values_[k].cost;
    if (k < layout_.num_links() && is_interval(k)) total += interval(z, k).cost();
  }
  return total;
}

void CentroidalNlp::cost_gradient(const VectorXd& z, Eigen::Ref<VectorXd> gradient) {
  evaluate(z, true);
  gradient.setZero();
  const auto own = [&](int k) { return gradient.segment(layout_.node(k), layout_.columns(k).size); };
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const VectorXd& slope = values_[k].cost_gradient;
    own(k) += slope.head(slope.size() - 1);
    double per_duration = slope(slope.size() - 1);
    if (k < layout_.num_links() && is_interval(k)) {
      double per_step = 0.0;
      interval(z, k).add_cost_gradient(own(k), own(k + 1), per_step);
      per_duration += share(k) * per_step;
    }
    if (layout_.duration(phase_of(k)) >= 0) gradient(layout_.duration(phase_of(k))) += per_duration;
  }
}

void CentroidalNlp::constraints(const VectorXd& z, Eigen::Ref<VectorXd> g) {
  evaluate(z, false);
  const Index nv = problem().robot.nv();
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const VectorXd& rows = values_[k].rows;
    g.segment(layout_.node_row(k), rows.size()) = rows;
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    auto rows = g.segment(layout_.link_row(k), layout_.link_row(k + 1) - layout_.link_row(k));
    if (is_interval(k)) {
      rows = interval(z, k).rows();
      continue;
    }  // both nodes of a phase transition have one chart
    const int here = layout_.node(k), next = layout_.node(k + 1);
    rows.head(2 * nv) = z.segment(next, 2 * nv) - z.segment(here, 2 * nv);
    rows.tail<3>() = (z.segment<3>(next + layout_.columns(k + 1).com_velocity) -
                      z.segment<3>(here + layout_.columns(k).com_velocity)) /
                     scale_.speed;
  }
}

void CentroidalNlp::fill_jacobian(const VectorXd& z) {
  evaluate(z, true);
  jacobian_.entries.clear();
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    for (const auto& [row, col, value] : values_[k].jacobian.entries) {
      jacobian_.entries.push_back({layout_.node_row(k) + row, layout_.node(k) + col, value});
    }
  }
  const int nv = problem().robot.nv();
  for (int k = 0; k < layout_.num_links(); ++k) {
    const int row = layout_.link_row(k), here = layout_.node(k), next = layout_.node(k + 1);
    if (is_interval(k)) {
      interval(z, k).add_jacobian(row, here, next, layout_.duration(phase_of(k)), share(k), jacobian_);
      continue;
    }
    jacobian_.diagonal(row, here, 2 * nv, -1.0);
    jacobian_.diagonal(row, next, 2 * nv, 1.0);
    jacobian_.diagonal(row + 2 * nv, here + layout_.columns(k).com_velocity, 3, -1.0 / scale_.speed);
    jacobian_.diagonal(row + 2 * nv, next + layout_.columns(k + 1).com_velocity, 3, 1.0 / scale_.speed);
  }
}

void CentroidalNlp::jacobian(const VectorXd& z, Eigen::Ref<VectorXd> values) {
  fill_jacobian(z);
  Index next = 0;
  for (const SparseEntries::Entry& entry : jacobian_.entries) values(next++) = entry.value;
}

template <class Emit>
void CentroidalNlp::visit_hessian(const HessianBlocks& blocks, Emit emit) const {
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const int first = layout_.node(k), size = layout_.columns(k).size, duration = layout_.duration(phase_of(k));
    for (const auto& [i, j] : node_entries_[k]) {
      emit(i < size ? first + i : duration, first + j, blocks.nodes[k](i, j));
    }
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (!is_interval(k)) continue;
    const CentroidalInterval::Between& between = blocks.between[k];
    const int here = layout_.node(k), next = layout_.node(k + 1);
    const int v0 = here + layout_.columns(k).v, v1 = next + layout_.columns(k + 1).v;
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 3; ++j) emit(i < 3 ? next + 3 + i : v1 + i, here + 3 + j, between.turn(i, j));
    }
    for (int i = 3; i < problem().robot.nv(); ++i) emit(v1 + i, v0 + i, between.v(i));
  }
  for (int p = 0; p < static_cast<int>(problem().phases.size()); ++p) {
    if (layout_.duration(p) >= 0) emit(layout_.duration(p), layout_.duration(p), blocks.durations(p));
  }
}

void CentroidalNlp::hessian(const VectorXd& z, double cost_factor, const VectorXd& multipliers,
                            Eigen::Ref<VectorXd> values) {
  const VectorXd on_rows =
      hessian_kind_ == HessianKind::exact ? multipliers : VectorXd(VectorXd::Zero(multipliers.size()));
  HessianBlocks blocks{std::vector<MatrixXd>(static_cast<std::size_t>(layout_.num_nodes())),
                       std::vector<CentroidalInterval::Between>(static_cast<std::size_t>(layout_.num_links())),
                       VectorXd::Zero(static_cast<Index>(problem().phases.size()))};
  CentroidalValues scratch;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const CentroidalPoint here = point(z, k);
    node(k).evaluate(here, scratch);
    node(k).add_derivatives(here, scratch);
    node(k).hessian(here, cost_factor, on_rows.segment(layout_.node_row(k), node(k).num_rows(here.node)),
                    blocks.nodes[k]);
  }
  for (int k = 0; k < layout_.num_links(); ++k) {
    if (!is_interval(k)) continue;
    const int row = layout_.link_row(k);
    blocks.between[k] = interval(z, k).add_hessian(cost_factor, on_rows.segment(row, layout_.link_row(k + 1) - row),
                                                   share(k), blocks.nodes[k], blocks.nodes[k + 1]);
  }
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const MatrixXd& block = blocks.nodes[k];
    blocks.durations(phase_of(k)) += block(block.rows() - 1, block.cols() - 1);
  }
  Index next = 0;
  visit_hessian(blocks, [&](int, int, double value) { values(next++) = value; });
}

void CentroidalNlp::set_patterns(const Trajectory& guess) {
  const auto add = [](SparsityPattern& pattern, int row, int col) {
    pattern.rows.push_back(row);
    pattern.cols.push_back(col);
  };
  fill_jacobian(pack(guess));
  for (const SparseEntries::Entry& entry : jacobian_.entries) add(jacobian_pattern_, entry.row, entry.col);

  HessianBlocks blocks{{},
                       std::vector<CentroidalInterval::Between>(static_cast<std::size_t>(layout_.num_links())),
                       VectorXd::Zero(static_cast<Index>(problem().phases.size()))};
  for (CentroidalInterval::Between& between : blocks.between) between.v.setZero(problem().robot.nv());
  Eigen::Matrix<bool, Eigen::Dynamic, Eigen::Dynamic> marks;
  for (int k = 0; k < layout_.num_nodes(); ++k) {
    const CentroidalColumns& at = layout_.columns(k);
    blocks.nodes.push_back(MatrixXd::Zero(at.size + 1, at.size + 1));
    node(k).mark_hessian(mesh_node(k).node, marks);
    std::vector<std::pair<int, int>>& entries = node_entries_.emplace_back();
    for (int j = 0; j < at.size; ++j) {
      for (int i = j; i < at.size; ++i) {
        if (marks(i, j)) entries.emplace_back(i, j);
      }
      const bool is_com = j >= at.com && j < at.com_velocity;
      const bool is_momentum_or_contact =
          j >= at.momentum && j < (at.ends_interval() ? at.com_acceleration : at.size);  // h and c
      if (layout_.duration(phase_of(k)) >= 0 && !is_com && !is_momentum_or_contact) entries.emplace_back(at.size, j);
    }
  }
  visit_hessian(blocks, [&](int row, int col, double) { add(hessian_pattern_, row, col); });
}

}  // namespace prowl

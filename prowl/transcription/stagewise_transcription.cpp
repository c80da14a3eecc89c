#include "prowl/transcription/stagewise_transcription.hpp"

#include <algorithm>

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using Entry = Eigen::SparseMatrix<double>::InnerIterator;

}  // namespace

void StagewiseTranscription::use_threads(int count) {
  const std::size_t shapes = works_.front().size();
  works_.clear();
  while (std::ssize(works_) < count) works_.emplace_back(shapes);
}

HalfTime StagewiseTranscription::half_time(int k, int i, const VectorXd& node) const {
  const PhaseMesh& mesh = discrete_.phase_mesh_of(k);
  if (i < 0 || i == mesh.intervals()) return {};
  const double slope = 0.5 * mesh.step(i, 1.0);
  if (!nodes_.functions(k).has_free_duration()) return {slope * discrete_.phase_of(k).duration.min, slope, -1};
  const int column = layout_.node_size(k);  // first shared variable
  return {slope * node(column), slope, column};
}

void StagewiseTranscription::set_arrival(int k, const VectorXd& ux, VectorXd& state, Arrival& arrival) const {
  const Stage& stage = this->stage(k);
  state = stage.fixed;
  for (std::size_t i = 0; i < stage.variables.size(); ++i) {
    state(stage.variables[i]) = ux(static_cast<Index>(i)) * stage.unit(static_cast<Index>(i));
  }
  arrival.set(nodes_.chart(k), layout_.nv(), half_time(k, discrete_.nodes[k].node - 1, state), state,
              nodes_.correction(k));
}

void StagewiseTranscription::move_to(int k, const VectorXd& ux) {
  Stage& stage = this->stage(k);
  if (stage.at.size() == ux.size() && stage.at == ux) return;
  stage.have_values = stage.have_derivatives = false;
  stage.at = ux;
  set_arrival(k, ux, work(stage).state, stage.arrival);
  const VectorXd& node = stage.node();
  if (stage.num_next() > 0) {
    stage.departure.set(nodes_.chart(k), nodes_.chart(k + 1), layout_.nv(), half_time(k, discrete_.nodes[k].node, node),
                        node);
  }
  nodes_.set_point(k, node, stage.point);
}

void StagewiseTranscription::fill_values(int k, const NodeValues& node) {
  Stage& stage = this->stage(k);
  stage.values.cost = node.cost;
  const auto function = [&](int index) {
    if (index < stage.num_rows) return node.rows(index);
    const int i = index - stage.num_rows;
    return stage.node()(stage.bounded[i]) * stage.per_unit(i);
  };
  stage.values.equalities.resize(stage.size.equalities);
  for (int i = 0; i < stage.size.equalities; ++i) {
    stage.values.equalities(i) = function(stage.equalities[i]) - stage.level(i);
  }
  stage.values.inequalities.resize(stage.size.inequalities);
  for (int i = 0; i < stage.size.inequalities; ++i) {
    stage.values.inequalities(i) = function(stage.inequalities[i]);
  }
  if (stage.num_next() > 0) {
    const Index states = 2 * layout_.nv();
    stage.departure.value(stage.values.next.head(states));
    for (std::size_t i = 0; i < stage.carried.size(); ++i) {
      stage.values.next(states + static_cast<Index>(i)) = stage.node()(stage.carried[i]);
    }
    stage.values.next.array() *= stage.next_per_unit.array();
  }
  stage.have_values = true;
}

const StageValues& StagewiseTranscription::values(int k, const VectorXd& ux) {
  move_to(k, ux);
  Stage& stage = this->stage(k);
  if (stage.have_values) return stage.values;
  NodeValues& node = work(stage).values;
  nodes_.at_node(k, [&] { nodes_.functions(k).evaluate(stage.point, node); });
  fill_values(k, node);
  return stage.values;
}

void StagewiseTranscription::fill_slopes(int k, const NodeValues& node) {
  Stage& stage = this->stage(k);
  Work& work = this->work(stage);
  const MatrixXd& jacobian = node.rows_jacobian;
  const Index size = stage.node().size();

  work.on_node = node.cost_gradient;
  stage.arrival.pull_back(work.on_node);
  stage.slopes.cost_gradient.resize(stage.size.variables());
  for (Index i = 0; i < stage.slopes.cost_gradient.size(); ++i) {
    stage.slopes.cost_gradient(i) = stage.unit(i) * work.on_node(stage.variables[i]);
  }

  MatrixXd& slopes = work.slopes;
  slopes.resize(stage.num_rows + kBaseRows, size);
  slopes.topRows(stage.num_rows) = jacobian.topRows(stage.num_rows);
  fill_base_slopes(stage, slopes);
  const Index rows = stage.slopes.rows.cols(), first = stage.num_first_equalities;
  for (Index j = 0; j < stage.size.variables(); ++j) {
    const auto column = slopes.col(stage.variables[j]);
    const double unit = stage.unit(j);
    auto equalities = stage.slopes.equalities.col(j);
    equalities.head(first) = unit * column.head(first);
    for (Index i = first; i < equalities.size(); ++i) {
      const int row = stage.equalities[i], bound = row - stage.num_rows;  // a bound if both sides are equal
      equalities(i) =
          unit * (bound < 0 ? column(row) : stage.per_unit(bound) * bound_slope(k, slopes, bound, stage.variables[j]));
    }
    for (Index i = 0; i < rows; ++i) stage.slopes.rows(j, i) = unit * column(stage.inequalities[i]);
  }
  for (Index i = 0; i < stage.slopes.bounds.cols(); ++i) {
    const int bound = stage.inequalities[rows + i] - stage.num_rows;
    for (Entry entry(stage.slopes.bounds, i); entry; ++entry) {
      entry.valueRef() =
          stage.per_unit(bound) * stage.unit(entry.row()) * bound_slope(k, slopes, bound, stage.variables[entry.row()]);
    }
  }
  for (Index j = 0; j < stage.slopes.next.cols(); ++j) {
    for (Entry entry(stage.slopes.next, j); entry; ++entry) {
      entry.valueRef() = stage.next_per_unit(entry.row()) * stage.unit(j) *
                         next_slope(k, slopes, static_cast<int>(entry.row()), stage.variables[j]);
    }
  }
  stage.have_derivatives = true;
}

void StagewiseTranscription::fill_base_slopes(Stage& stage, MatrixXd& slopes) const {
  auto own = slopes.bottomRows(kBaseRows).topRows<6>();
  own.setZero();
  own.leftCols<6>().setIdentity();
  auto next = slopes.bottomRows<6>();
  if (stage.num_next() > 0) {
    stage.departure.base_derivatives(next);
  } else {
    next.setZero();
  }
  stage.arrival.pull_back(slopes);
}

double StagewiseTranscription::entry(int k, const Arrival::JointRow& row, int dof, int variable) const {
  const int nv = layout_.nv();
  if (variable < 3 * nv) {
    if (variable % nv != dof) return 0.0;
    return variable < nv ? row.q : variable < 2 * nv ? row.v : row.a;
  }
  const bool is_duration = nodes_.functions(k).has_free_duration() && variable == layout_.node_size(k);
  return is_duration ? row.duration : 0.0;
}

double StagewiseTranscription::bound_slope(int k, const MatrixXd& slopes, int i, int variable) const {
  const Stage& stage = this->stage(k);
  const int of = stage.bounded[i], nv = layout_.nv();
  if (of < 6) return slopes(slopes.rows() - kBaseRows + of, variable);
  if (of < nv) return entry(k, stage.arrival.pull_back({.q = 1.0}, of), of, variable);
  if (of < 2 * nv) return entry(k, stage.arrival.pull_back({.v = 1.0}, of - nv), of - nv, variable);
  return of == variable ? 1.0 : 0.0;
}

double StagewiseTranscription::next_slope(int k, const MatrixXd& slopes, int i, int variable) const {
  const Stage& stage = this->stage(k);
  const int nv = layout_.nv();
  if (i < 6) return slopes(slopes.rows() - 6 + i, variable);
  if (i < 2 * nv) {
    const int dof = i % nv;
    return entry(k, stage.arrival.pull_back(stage.departure.joint_derivatives(i), dof), dof, variable);
  }
  return stage.carried[i - 2 * nv] == variable ? 1.0 : 0.0;
}

void StagewiseTranscription::add_on_next(const Stage& stage, const VectorXd& on_next, VectorXd& on_node) const {
  const Index states = 2 * layout_.nv();
  on_node.head(states) += on_next.head(states).cwiseProduct(stage.next_per_unit.head(states));
  for (std::size_t i = 0; i < stage.carried.size(); ++i) {
    const Index state = states + static_cast<Index>(i);
    on_node(stage.carried[i]) += on_next(state) * stage.next_per_unit(state);
  }
}

void StagewiseTranscription::gather(const Stage& stage, const MatrixXd& form, MatrixXd& result) {
  const Index size = stage.size.variables();
  result.resize(size, size);
  for (Index j = 0; j < size; ++j) {
    const int own = stage.variables[j];
    for (const Stage::Run& run : stage.runs) {
      const Index skipped = std::max<Index>(0, j - run.first), length = run.length - skipped;
      if (length <= 0) continue;
      const Index first = run.first + skipped, variable = run.variable + skipped;
      const auto units = stage.unit(j) * stage.unit.segment(first, length);
      auto to = result.col(j).segment(first, length);
      if (variable >= own) {
        to = units.cwiseProduct(form.col(own).segment(variable, length));
      } else {
        to = units.cwiseProduct(form.row(own).segment(variable, length).transpose());
      }
    }
  }
}

void StagewiseTranscription::linearise(int k, const VectorXd& ux, double cost_factor,
                                       const StageMultipliers& multipliers) {
  move_to(k, ux);
  Stage& stage = this->stage(k);
  Work& work = this->work(stage);
  const bool is_exact = nodes_.functions(k).hessian_kind() == HessianKind::exact;
  work.on_rows.setZero(stage.num_rows);
  work.on_node.setZero(stage.node().size());
  const auto distribute = [&](const std::vector<int>& functions, const VectorXd& on) {
    for (std::size_t i = 0; i < functions.size(); ++i) {
      const int bound = functions[i] - stage.num_rows;
      if (bound < 0) {
        work.on_rows(functions[i]) = on(static_cast<Index>(i));
      } else {
        const int variable = stage.bounded[bound];
        work.on_node(variable) += on(static_cast<Index>(i)) * stage.per_unit(bound);
      }
    }
  };
  distribute(stage.equalities, multipliers.equalities);
  distribute(stage.inequalities, multipliers.inequalities);
  nodes_.at_node(
      k, [&] { nodes_.functions(k).linearise(stage.point, cost_factor, work.on_rows, work.values, work.form); });
  if (stage.num_next() > 0) {
    work.on_next.setZero(stage.node().size());
    add_on_next(stage, multipliers.next, work.on_next);
    if (is_exact) stage.departure.add_hessian(work.on_next, work.form);
    stage.departure.pull_back(work.on_next);
    work.on_node += work.on_next;
  }
  work.on_node += cost_factor * work.values.cost_gradient;
  work.on_node.noalias() += work.values.rows_jacobian.transpose() * work.on_rows;
  is_exact ? stage.arrival.pull_back_hessian(work.form, work.on_node) : stage.arrival.pull_back_form(work.form);
  gather(stage, work.form, stage.slopes.hessian);
  if (!stage.have_values) fill_values(k, work.values);
  if (!stage.have_derivatives) fill_slopes(k, work.values);
}

void StagewiseTranscription::linearise_to_first_order(int k, const VectorXd& ux) {
  move_to(k, ux);
  Stage& stage = this->stage(k);
  if (!stage.have_derivatives) {
    NodeValues& node = work(stage).values;
    nodes_.at_node(k, [&] { nodes_.functions(k).evaluate_with_derivatives(stage.point, node); });
    if (!stage.have_values) fill_values(k, node);
    fill_slopes(k, node);
  }
}

void StagewiseTranscription::add_condensed(int k, const MatrixXd& next_hessian, const VectorXd& weights,
                                           MatrixXd& result) {
  const Stage& stage = this->stage(k);
  work(stage).condenser.add(stage.slopes, next_hessian, weights, result);
}

void StagewiseTranscription::push_forward(int k, const VectorXd& step, VectorXd& next, VectorXd& inequalities) {
  stage(k).slopes.push_forward(step, next, inequalities);
}

void StagewiseTranscription::add_pull_back(int k, const VectorXd& on_next, const VectorXd& on_inequalities,
                                           VectorXd& gradient) {
  stage(k).slopes.add_pull_back(on_next, on_inequalities, gradient);
}

const StageDerivatives& StagewiseTranscription::derivatives(int k, const VectorXd& ux) {
  linearise_to_first_order(k, ux);
  Stage& stage = this->stage(k);
  StageDerivatives& derivatives = stage.derivatives;
  derivatives.cost_gradient = stage.slopes.cost_gradient;
  derivatives.equalities = stage.slopes.equalities;
  derivatives.inequalities.resize(stage.size.inequalities, stage.size.variables());
  derivatives.inequalities.topRows(stage.slopes.rows.cols()) = stage.slopes.rows.transpose();
  derivatives.inequalities.bottomRows(stage.slopes.bounds.cols()) = MatrixXd(stage.slopes.bounds).transpose();
  derivatives.next = stage.slopes.next;
  return derivatives;
}

const MatrixXd& StagewiseTranscription::hessian(int k, const VectorXd& ux, double cost_factor,
                                                const StageMultipliers& multipliers) {
  linearise(k, ux, cost_factor, multipliers);
  MatrixXd& hessian = stage(k).slopes.hessian;
  hessian.triangularView<Eigen::StrictlyUpper>() = hessian.transpose();
  return hessian;
}

std::vector<VectorXd> StagewiseTranscription::stages(const VectorXd& z) const {
  std::vector<VectorXd> result;
  for (int k = 0; k < num_stages(); ++k) {
    VectorXd node(stage(k).fixed.size());
    for (Index i = 0; i < node.size(); ++i) node(i) = z(nodes_.column(k, static_cast<int>(i)));
    const double s = half_time(k, discrete_.nodes[k].node - 1, node).s;
    const VectorXd state = Arrival::state(nodes_.chart(k), layout_.nv(), s, node, nodes_.correction(k));
    result.push_back(state(stage(k).variables).cwiseQuotient(stage(k).unit));
  }
  return result;
}

VectorXd StagewiseTranscription::flat(const std::vector<VectorXd>& stages) const {
  VectorXd z(layout_.num_variables()), state;
  for (int k = num_stages() - 1; k >= 0; --k) {  // shared variables keep the value of their first stage
    Arrival arrival;
    set_arrival(k, stages[k], state, arrival);
    const VectorXd& node = arrival.node();
    for (Index i = 0; i < node.size(); ++i) z(nodes_.column(k, static_cast<int>(i))) = node(i);
  }
  return z;
}

std::string StagewiseTranscription::describe_stage(int k) const { return discrete_.describe_moment(k); }

}  // namespace prowl

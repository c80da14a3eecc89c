#include "prowl/transcription/stagewise_transcription.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

StagewiseTranscription::StagewiseTranscription(Transcription& flat)
    : flat_(flat), stages_(static_cast<std::size_t>(flat.layout_.num_nodes())), scratch_(flat.variable_lower_) {
  for (int k = 0; k < num_stages(); ++k) set_variables(k);
  for (int k = 0; k < num_stages(); ++k) set_functions(k);
}

std::pair<double, double> StagewiseTranscription::bounds(int k, int variable) const {
  const int own = flat_.column(k, variable);
  double lower = flat_.variable_lower_(own), upper = flat_.variable_upper_(own);
  const bool is_state = variable < 2 * flat_.layout_.nv();
  if (is_state && k + 1 < num_stages() && !flat_.is_interval(k)) {
    const int twin = flat_.column(k + 1, variable);
    lower = std::max(lower, flat_.variable_lower_(twin));
    upper = std::min(upper, flat_.variable_upper_(twin));
  }
  return {lower, upper};
}

VectorXd StagewiseTranscription::units(int k) const {
  const RobotModel& robot = flat_.problem_.robot;
  const int nv = flat_.layout_.nv(), nu = flat_.layout_.nu(), own = flat_.layout_.node_size(k);
  const double length = robot.size(), time = std::sqrt(length / RobotModel::kGravity), force = robot.weight();
  VectorXd q = VectorXd::Ones(nv);
  VectorXd tau = VectorXd::Constant(nu, force * length);
  q.head<3>().setConstant(length);
  for (int i = 0; i < nu; ++i) {
    if (!robot.joint_is_prismatic()[static_cast<std::size_t>(i)]) continue;
    q(6 + i) = length;
    tau(i) = force;
  }
  VectorXd units = VectorXd::Constant(flat_.functions(k).num_columns(), length);
  // Dependent forces stay in newtons: they cost nothing, and what regularises them is all that holds them at first.
  units.head(own) << q, q / time, q / (time * time), tau, VectorXd::Ones(flat_.layout_.num_w(k));
  if (flat_.functions(k).has_free_duration()) units(own) = time;
  return units;
}

void StagewiseTranscription::set_variables(int k) {
  Stage& stage = this->stage(k);
  const int states = 2 * flat_.layout_.nv(), own = flat_.layout_.node_size(k), all = flat_.functions(k).num_columns();
  const auto is_shared_with = [&](int other, int variable) {
    if (other < 0 || other >= num_stages()) return false;
    const std::vector<int>& shared = flat_.shared_[static_cast<std::size_t>(flat_.phase_of(other))];
    return std::ranges::find(shared, flat_.column(k, variable)) != shared.end();
  };

  stage.fixed.setZero(all);
  std::vector<int> carried_here;
  for (int i = 0; i < all; ++i) {
    if (i < states && k > 0) continue;
    const auto [lower, upper] = bounds(k, i);
    if (lower == upper) {
      stage.fixed(i) = lower;
      continue;
    }
    if (i < states) throw InputError("the start has to fix all positions and velocities");
    const bool is_shared = i >= own;
    (is_shared && is_shared_with(k - 1, i) ? carried_here : stage.variables).push_back(i);
    if (is_shared && is_shared_with(k + 1, i)) stage.carried.push_back(i);
  }
  stage.size.inputs = static_cast<int>(stage.variables.size());
  for (int i = 0; i < states && k > 0; ++i) stage.variables.push_back(i);
  stage.variables.insert(stage.variables.end(), carried_here.begin(), carried_here.end());
  stage.size.states = static_cast<int>(stage.variables.size()) - stage.size.inputs;
  stage.unit = units(k)(stage.variables);
}

void StagewiseTranscription::set_functions(int k) {
  Stage& stage = this->stage(k);
  std::vector<double> level, lower, upper, per_unit;
  const auto add = [&](double low, double up) {
    if (low == up) {
      stage.equalities.push_back(stage.num_functions);
      level.push_back(low);
    } else if (std::isfinite(low) || std::isfinite(up)) {
      stage.inequalities.push_back(stage.num_functions);
      lower.push_back(low);
      upper.push_back(up);
    }
    ++stage.num_functions;
  };
  const NodeFunctions& functions = flat_.functions(k);
  const MeshNode& node = flat_.mesh_node(k);
  for (int row = 0; row < functions.num_rows(node.node); ++row) {
    add(functions.lower(node.node, row), functions.upper(node.node, row));
  }

  const int states = 2 * flat_.layout_.nv();
  for (std::size_t i = 0; i < stage.variables.size(); ++i) {
    const int variable = stage.variables[i];
    const bool is_carried = variable >= states && static_cast<int>(i) >= stage.size.inputs;  // bounded where it began
    const bool is_twin = variable < states && node.h_in == 0.0;
    const auto [low, up] = bounds(k, variable);
    if (is_carried || is_twin || (!std::isfinite(low) && !std::isfinite(up))) continue;
    const double unit = stage.unit(static_cast<Index>(i));
    stage.bounded.push_back(variable);
    per_unit.push_back(1.0 / unit);
    add(low / unit, up / unit);
  }

  stage.size.equalities = static_cast<int>(stage.equalities.size());
  stage.size.inequalities = static_cast<int>(stage.inequalities.size());
  stage.level = Eigen::Map<VectorXd>(level.data(), stage.size.equalities);
  stage.lower = Eigen::Map<VectorXd>(lower.data(), stage.size.inequalities);
  stage.upper = Eigen::Map<VectorXd>(upper.data(), stage.size.inequalities);
  stage.per_unit = Eigen::Map<VectorXd>(per_unit.data(), static_cast<Index>(per_unit.size()));
  if (k + 1 < num_stages()) {
    const Stage& next = this->stage(k + 1);
    stage.next_per_unit = next.unit.tail(next.size.states).cwiseInverse();
    stage.values.next.resize(next.size.states);
  }
  stage.num_functions += static_cast<int>(stage.values.next.size());
}

HalfTime StagewiseTranscription::half_time(int k, double h, const VectorXd& node) const {
  if (h == 0.0) return {};
  const Phase& phase = flat_.problem_.phases[static_cast<std::size_t>(flat_.phase_of(k))];
  const double slope = 0.5 / phase.intervals;
  if (!flat_.functions(k).has_free_duration()) return {slope * phase.duration.min, slope, -1};
  const int column = flat_.layout_.node_size(k);  // the first of what is shared
  return {slope * node(column), slope, column};
}

Arrival StagewiseTranscription::arrival(int k, const VectorXd& ux) const {
  VectorXd state = stage(k).fixed;
  state(stage(k).variables) = ux.cwiseProduct(stage(k).unit);
  return {flat_.charts_[static_cast<std::size_t>(k)], flat_.layout_.nv(),
          half_time(k, flat_.mesh_node(k).h_in, state), state};
}

Departure StagewiseTranscription::departure(int k) const {
  const VectorXd& node = stage(k).node;
  return {flat_.charts_[static_cast<std::size_t>(k)], flat_.charts_[static_cast<std::size_t>(k) + 1],
          flat_.layout_.nv(), half_time(k, flat_.mesh_node(k).h_out, node), node};
}

void StagewiseTranscription::move_to(int k, const VectorXd& ux) {
  Stage& stage = this->stage(k);
  if (stage.at.size() == ux.size() && stage.at == ux) return;
  stage.have_values = stage.have_derivatives = false;
  stage.at = ux;
  stage.node = arrival(k, ux).node();
  for (Index i = 0; i < stage.node.size(); ++i) scratch_(flat_.column(k, static_cast<int>(i))) = stage.node(i);
  stage.point = flat_.node_point(scratch_, k);
}

void StagewiseTranscription::evaluate(int k, bool with_derivatives) {
  Stage& stage = this->stage(k);
  NodeFunctions& functions = flat_.functions(k);
  flat_.at_node(k, [&] {
    with_derivatives ? functions.evaluate_with_derivatives(stage.point, stage.node_values)
                     : functions.evaluate(stage.point, stage.node_values);
  });
}

const StageValues& StagewiseTranscription::values(int k, const VectorXd& ux) {
  move_to(k, ux);
  Stage& stage = this->stage(k);
  if (stage.have_values) return stage.values;
  evaluate(k, false);
  stage.values.cost = stage.node_values.cost;
  VectorXd functions(stage.first_next());
  functions << stage.node_values.rows, stage.node(stage.bounded).cwiseProduct(stage.per_unit);
  stage.values.equalities = functions(stage.equalities) - stage.level;
  stage.values.inequalities = functions(stage.inequalities);
  if (stage.values.next.size() > 0) {
    stage.values.next << departure(k).value(), stage.node(stage.carried);
    stage.values.next.array() *= stage.next_per_unit.array();
  }
  stage.have_values = true;
  return stage.values;
}

const StageDerivatives& StagewiseTranscription::derivatives(int k, const VectorXd& ux) {
  move_to(k, ux);
  Stage& stage = this->stage(k);
  if (stage.have_derivatives) return stage.derivatives;
  evaluate(k, true);
  MatrixXd& slopes = stage.slopes;
  slopes.setZero(stage.num_functions, stage.node.size());
  Index row = stage.node_values.rows_jacobian.rows();
  slopes.topRows(row) = stage.node_values.rows_jacobian;
  for (std::size_t i = 0; i < stage.bounded.size(); ++i) {
    slopes(row++, stage.bounded[i]) = stage.per_unit(static_cast<Index>(i));
  }
  if (stage.values.next.size() > 0) {
    const Index states = 2 * flat_.layout_.nv();
    departure(k).derivatives(slopes.middleRows(row, states));
    row += states;
    for (const int variable : stage.carried) slopes(row++, variable) = 1.0;
    slopes.bottomRows(stage.values.next.size()).array().colwise() *= stage.next_per_unit.array();
  }

  const Arrival arrival = this->arrival(k, ux);
  MatrixXd pulled(stage.num_functions + 1, stage.node.size());
  pulled << slopes, stage.node_values.cost_gradient.transpose();
  arrival.pull_back(pulled);
  StageDerivatives& derivatives = stage.derivatives;
  pulled = stage.of_stage(pulled);
  derivatives.equalities = pulled(stage.equalities, Eigen::all);
  derivatives.inequalities = pulled(stage.inequalities, Eigen::all);
  derivatives.next = pulled.middleRows(stage.first_next(), stage.values.next.size());
  derivatives.cost_gradient = pulled.bottomRows<1>().transpose();
  stage.have_derivatives = true;
  return derivatives;
}

const MatrixXd& StagewiseTranscription::hessian(int k, const VectorXd& ux, double cost_factor,
                                                const StageMultipliers& multipliers) {
  derivatives(k, ux);
  Stage& stage = this->stage(k);
  VectorXd on_functions = VectorXd::Zero(stage.num_functions);
  on_functions(stage.equalities) = multipliers.equalities;
  on_functions(stage.inequalities) = multipliers.inequalities;
  if (stage.values.next.size() > 0) on_functions.tail(stage.values.next.size()) = multipliers.next;

  MatrixXd hessian;
  flat_.at_node(k, [&] {
    flat_.functions(k).hessian(stage.point, cost_factor, on_functions.head(stage.node_values.rows.size()), hessian);
  });
  if (stage.values.next.size() > 0) {
    const VectorXd on_next = multipliers.next.cwiseProduct(stage.next_per_unit);
    departure(k).add_hessian(on_next, hessian);
  }
  const VectorXd gradient = cost_factor * stage.node_values.cost_gradient + stage.slopes.transpose() * on_functions;
  arrival(k, ux).pull_back(hessian, gradient);
  stage.hessian = stage.unit.asDiagonal() * stage.of_stage(hessian(stage.variables, Eigen::all));
  return stage.hessian;
}

std::vector<VectorXd> StagewiseTranscription::stages(const VectorXd& z) const {
  std::vector<VectorXd> result;
  for (int k = 0; k < num_stages(); ++k) {
    VectorXd node(stage(k).fixed.size());
    for (Index i = 0; i < node.size(); ++i) node(i) = z(flat_.column(k, static_cast<int>(i)));
    const double s = half_time(k, flat_.mesh_node(k).h_in, node).s;
    const VectorXd state = Arrival::state(flat_.charts_[static_cast<std::size_t>(k)], flat_.layout_.nv(), s, node);
    result.push_back(state(stage(k).variables).cwiseQuotient(stage(k).unit));
  }
  return result;
}

VectorXd StagewiseTranscription::flat(const std::vector<VectorXd>& stages) const {
  VectorXd z(flat_.num_variables());
  for (int k = num_stages() - 1; k >= 0; --k) {  // what is shared: as it began
    const VectorXd node = arrival(k, stages[static_cast<std::size_t>(k)]).node();
    for (Index i = 0; i < node.size(); ++i) z(flat_.column(k, static_cast<int>(i))) = node(i);
  }
  return z;
}

std::string StagewiseTranscription::describe_stage(int k) const {
  return flat_.describe_place(k);
}

}  // namespace prowl

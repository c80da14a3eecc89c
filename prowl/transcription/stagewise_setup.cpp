// What StagewiseTranscription determines once: variables, functions and patterns of its stages.
#include <algorithm>
#include <array>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/transcription/stagewise_transcription.hpp"
#include "prowl/transcription/variable_units.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

}  // namespace

StagewiseTranscription::StagewiseTranscription(NodeProgram& nodes)
    : nodes_(nodes), discrete_(nodes.discrete()), layout_(nodes.layout()), stages_(nodes.num_nodes()) {
  for (int k = 0; k < num_stages(); ++k) set_variables(k);
  for (int k = 0; k < num_stages(); ++k) set_functions(k);
  for (int k = 0; k < num_stages(); ++k) set_patterns(k);
  set_shapes();
  set_closure();
}

/// In the units of the bounds that are its rows: end - start, moved by the cycle. Its displacement is in their level.
void StagewiseTranscription::set_closure() {
  if (!discrete_.problem.cycle) return;
  const int states = 2 * layout_.nv();
  MatrixXd moved = MatrixXd::Identity(states, states);
  moved.topLeftCorner<3, 3>() = discrete_.problem.cycle->rotation();
  const Stage& first = stage(0);
  const VectorXd unit = units(0).head(states);
  closure_.setZero(states, first.size.variables());
  for (Index j = 0; j < closure_.cols(); ++j) {
    const int variable = first.variables[static_cast<std::size_t>(j)];
    if (variable < states) closure_.col(j) = -first.unit(j) * moved.col(variable).cwiseQuotient(unit);
  }
}

void StagewiseTranscription::set_shapes() {
  std::vector<std::array<Index, 5>> shapes;
  for (Stage& stage : stages_) {
    const std::array<Index, 5> shape = {stage.fixed.size(), stage.num_rows, stage.size.equalities,
                                        stage.size.variables(), stage.num_next()};
    const auto known = std::ranges::find(shapes, shape);
    stage.shape = static_cast<std::size_t>(known - shapes.begin());
    if (known == shapes.end()) shapes.push_back(shape);
  }
  works_.clear();
  works_.emplace_back(shapes.size());
}

std::pair<double, double> StagewiseTranscription::bounds(int k, int variable) const {
  const int own = nodes_.column(k, variable);
  double lower = nodes_.bounds().lower(own), upper = nodes_.bounds().upper(own);
  const bool is_state = variable < 2 * layout_.nv();
  if (is_state && k + 1 < num_stages() && !discrete_.is_interval(k)) {
    const int twin = nodes_.column(k + 1, variable);
    lower = std::max(lower, nodes_.bounds().lower(twin));
    upper = std::min(upper, nodes_.bounds().upper(twin));
  }
  return {lower, upper};
}

VectorXd StagewiseTranscription::units(int k) const {
  const VariableUnits unit(discrete_.problem.robot);
  const VectorXd& q = unit.q;
  const double time = unit.time;
  const int own = layout_.node_size(k);
  VectorXd units = VectorXd::Constant(nodes_.functions(k).num_columns(), unit.length);
  // Dependent forces stay in newtons: they have no cost, and initially only regularisation
  // determines them.
  units.head(own) << q, q / time, q / (time * time), unit.tau, VectorXd::Ones(layout_.num_w(k));
  if (nodes_.functions(k).has_free_duration()) units(own) = time;
  return units;
}

void StagewiseTranscription::set_variables(int k) {
  Stage& stage = this->stage(k);
  const int states = 2 * layout_.nv(), own = layout_.node_size(k), all = nodes_.functions(k).num_columns();
  const auto is_shared_with = [&](int other, int variable) {
    if (other < 0 || other >= num_stages()) return false;
    const std::vector<int>& shared = nodes_.shared(nodes_.phase_of(other));
    return std::ranges::find(shared, nodes_.column(k, variable)) != shared.end();
  };

  stage.fixed.setZero(all);
  std::vector<int> carried_here, free_start;
  for (int i = 0; i < all; ++i) {
    if (i < states && k > 0) continue;
    const auto [lower, upper] = bounds(k, i);
    if (lower == upper) {
      stage.fixed(i) = lower;
      continue;
    }
    if (i < states) {
      free_start.push_back(i);
      continue;
    }
    const bool is_shared = i >= own;
    (is_shared && is_shared_with(k - 1, i) ? carried_here : stage.variables).push_back(i);
    if (is_shared && is_shared_with(k + 1, i)) stage.carried.push_back(i);
  }
  stage.variables.insert(stage.variables.end(), free_start.begin(), free_start.end());
  stage.size.inputs = static_cast<int>(stage.variables.size());
  for (int i = 0; i < states && k > 0; ++i) stage.variables.push_back(i);
  stage.variables.insert(stage.variables.end(), carried_here.begin(), carried_here.end());
  stage.size.states = static_cast<int>(stage.variables.size()) - stage.size.inputs;
  stage.unit = units(k)(stage.variables);
  for (int i = 0; i < stage.size.variables(); ++i) {
    const int variable = stage.variables[i];
    if (stage.runs.empty() || variable != stage.runs.back().variable + stage.runs.back().length)
      stage.runs.push_back({i, variable, 0});
    ++stage.runs.back().length;
  }
}

void StagewiseTranscription::set_functions(int k) {
  Stage& stage = this->stage(k);
  std::vector<double> level, lower, upper, per_unit;
  int count = 0;
  const auto add = [&](double low, double up) {
    if (low == up) {
      stage.equalities.push_back(count);
      level.push_back(low);
    } else if (std::isfinite(low) || std::isfinite(up)) {
      stage.inequalities.push_back(count);
      lower.push_back(low);
      upper.push_back(up);
    }
    ++count;
  };
  const NodeFunctions& functions = nodes_.functions(k);
  const MeshNode& node = discrete_.nodes[k];
  for (int row = 0; row < functions.num_rows(node.node); ++row) {
    add(functions.lower(node.node, row), functions.upper(node.node, row));
  }
  stage.num_rows = count;

  const int states = 2 * layout_.nv();
  for (std::size_t i = 0; i < stage.variables.size(); ++i) {
    const int variable = stage.variables[i];
    const bool is_carried =
        variable >= states && static_cast<int>(i) >= stage.size.inputs;  // bounded at its first stage
    const bool is_twin = k > 0 && variable < states && node.h_in == 0.0;
    const auto [low, up] = bounds(k, variable);
    if (is_carried || is_twin || (!std::isfinite(low) && !std::isfinite(up))) continue;
    const double unit = stage.unit(static_cast<Index>(i));
    stage.bounded.push_back(variable);
    per_unit.push_back(1.0 / unit);
    add(low / unit, up / unit);
  }

  if (const auto& cycle = discrete_.problem.cycle; cycle && k + 1 == num_stages()) {
    const VectorXd unit = units(k);
    for (int i = 0; i < states; ++i) {
      stage.bounded.push_back(i);
      per_unit.push_back(1.0 / unit(i));
      const double way = i < 3 ? cycle->displacement(i) / unit(i) : 0.0;
      add(way, way);
    }
  }

  stage.size.equalities = static_cast<int>(stage.equalities.size());
  while (stage.num_first_equalities < stage.size.equalities &&
         stage.equalities[stage.num_first_equalities] == stage.num_first_equalities)
    ++stage.num_first_equalities;
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
}

/// The slopes depend on which variables there are, not on where the robot is: found at a point where none vanishes by
/// chance.
void StagewiseTranscription::set_patterns(int k) {
  Stage& stage = this->stage(k);
  const Index size = stage.fixed.size(), variables = stage.size.variables();
  VectorXd state(size);
  for (Index i = 0; i < size; ++i) state(i) = std::sin(static_cast<double>(i + 1));
  stage.arrival.set(nodes_.chart(k), layout_.nv(), half_time(k, discrete_.nodes[k].node - 1, state), state,
                    nodes_.correction(k));
  if (stage.num_next() > 0) {
    const HalfTime time = half_time(k, discrete_.nodes[k].node, stage.node());
    stage.departure.set(nodes_.chart(k), nodes_.chart(k + 1), layout_.nv(), time, stage.node());
  }
  MatrixXd slopes(kBaseRows, size);
  fill_base_slopes(stage, slopes);
  const auto first_bound = std::ranges::find_if(stage.inequalities, [&](int index) { return index >= stage.num_rows; });
  const std::vector<int> of_bounds(first_bound, stage.inequalities.end());  // rows precede the bounds
  MatrixXd gradients(variables, std::ssize(of_bounds)), next(stage.num_next(), variables);
  for (Index j = 0; j < variables; ++j) {
    const int variable = stage.variables[j];
    for (Index i = 0; i < gradients.cols(); ++i)
      gradients(j, i) = bound_slope(k, slopes, of_bounds[i] - stage.num_rows, variable);
    for (Index i = 0; i < next.rows(); ++i) next(i, j) = next_slope(k, slopes, static_cast<int>(i), variable);
  }
  stage.slopes.bounds = gradients.sparseView();
  stage.slopes.next = next.sparseView();
  stage.slopes.equalities.resize(stage.size.equalities, variables);
  stage.slopes.rows.resize(variables, first_bound - stage.inequalities.begin());
}

}  // namespace prowl

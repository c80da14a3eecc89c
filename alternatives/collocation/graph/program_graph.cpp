#include "alternatives/collocation/graph/program_graph.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

ProgramGraph::Vector ProgramGraph::add(Node node) {
  nodes_.push_back(std::move(node));
  return {static_cast<int>(nodes_.size()) - 1};
}

ProgramGraph::Vector ProgramGraph::variables(int first, int size) {
  Node node{.kind = Kind::variables, .size = size, .first = first};
  node.derivative.setZero(size, num_locals_);
  node.derivative.middleCols(first, size).setIdentity();
  node.pattern = node.derivative.cast<float>();
  return add(std::move(node));
}

ProgramGraph::Vector ProgramGraph::outside(int size, Pattern pattern) {
  return add({.kind = Kind::outside, .size = size, .pattern = std::move(pattern)});
}

ProgramGraph::Vector ProgramGraph::slice(Vector of, int first, int size) {
  Node slice{.kind = Kind::slice, .size = size, .first = first, .terms = {{1.0, 0, of}}};
  slice.pattern = pattern(of).middleRows(first, size);
  return add(std::move(slice));
}

ProgramGraph::Vector ProgramGraph::sum(std::vector<Term> terms) {
  Node sum{.kind = Kind::sum, .size = size(terms.front().vector), .terms = std::move(terms)};
  sum.pattern.setZero(sum.size, num_locals_);
  for (const Term& term : sum.terms) {
    sum.pattern = sum.pattern.cwiseMax(pattern(term.vector));
    if (term.power != 0 && step_.variable >= 0) sum.pattern.col(step_.variable).setOnes();
  }
  return add(std::move(sum));
}

ProgramGraph::Vector ProgramGraph::call(DifferentiableFunction& function, std::vector<Vector> inputs) {
  Node call{.kind = Kind::call, .size = function.num_outputs(), .function = &function};
  Pattern rows(function.num_inputs(), num_locals_);
  Index row = 0;
  for (const Vector input : inputs) {
    call.terms.push_back({1.0, 0, input});
    rows.middleRows(row, size(input)) = pattern(input);
    row += size(input);
  }
  call.is_direct = std::ranges::all_of(inputs, [this](Vector v) { return node(v).kind == Kind::variables; });
  for (const Vector input : inputs) {
    for (int i = 0; call.is_direct && i < size(input); ++i) call.active.push_back(node(input).first + i);
  }
  for (int j = 0; !call.is_direct && j < num_locals_; ++j) {
    if (rows.col(j).maxCoeff() > 0.0F) call.active.push_back(j);
  }
  Pattern depends(call.size, function.num_inputs());
  for (int i = 0; i < depends.rows(); ++i) {
    for (int j = 0; j < depends.cols(); ++j) depends(i, j) = function.depends(i, j) ? 1.0F : 0.0F;
  }
  call.pattern = (depends * rows).cwiseMin(1.0F);
  return add(std::move(call));
}

ProgramGraph::Pattern ProgramGraph::hessian_pattern() const {
  Pattern result = Pattern::Zero(num_locals_, num_locals_);
  for (const Node& node : nodes_) {
    if (node.kind == Kind::sum && step_.variable >= 0) {
      for (const Term& term : node.terms) {
        if (term.power == 0) continue;
        const Eigen::RowVectorXf columns = pattern(term.vector).colwise().maxCoeff();
        result.row(step_.variable) += columns;
        result.col(step_.variable) += columns.transpose();
        if (term.power > 1) result(step_.variable, step_.variable) += 1.0F;
      }
    } else if (node.kind == Kind::call) {
      const DifferentiableFunction& function = *node.function;
      Pattern rows(function.num_inputs(), num_locals_);
      Index row = 0;
      for (const Term& input : node.terms) {
        rows.middleRows(row, size(input.vector)) = pattern(input.vector);
        row += size(input.vector);
      }
      Pattern bends(rows.rows(), rows.rows());
      for (int i = 0; i < bends.rows(); ++i) {
        for (int j = 0; j < bends.cols(); ++j) bends(i, j) = function.bends(i, j) ? 1.0F : 0.0F;
      }
      result += rows.transpose() * (bends * rows);
    }
  }
  return result.cwiseMin(1.0F);
}

double ProgramGraph::step_power(int power) const { return power == 0 ? 1.0 : power == 1 ? h_ : std::pow(h_, power); }

double ProgramGraph::step_power_slope(int power) const {
  return power == 0 ? 0.0 : power * step_.share * step_power(power - 1);
}

void ProgramGraph::set_outside(Vector v, const VectorXd& value) { node(v).value = value; }

void ProgramGraph::set_outside_derivative(Vector v, const MatrixXd& derivative) { node(v).derivative = derivative; }

void ProgramGraph::evaluate(const VectorXd& locals, bool with_derivatives) {
  h_ = step_.variable >= 0 ? step_.share * locals(step_.variable) : step_.fixed;
  for (Node& node : nodes_) {
    switch (node.kind) {
      case Kind::variables: node.value = locals.segment(node.first, node.size); break;
      case Kind::outside: break;
      case Kind::slice: {
        const Node& of = this->node(node.terms.front().vector);
        node.value = of.value.segment(node.first, node.size);
        if (with_derivatives) node.derivative = of.derivative.middleRows(node.first, node.size);
        break;
      }
      case Kind::sum: evaluate_sum(node, with_derivatives); break;
      case Kind::call: evaluate_call(node, with_derivatives); break;
    }
  }
}

void ProgramGraph::evaluate_sum(Node& sum, bool with_derivatives) {
  sum.value.setZero(sum.size);
  if (with_derivatives) sum.derivative.setZero(sum.size, num_locals_);
  for (const auto& [factor, power, vector] : sum.terms) {
    const Node& term = node(vector);
    const double weight = factor * step_power(power);
    sum.value += weight * term.value;
    if (!with_derivatives) continue;
    sum.derivative += weight * term.derivative;
    if (power != 0 && step_.variable >= 0) {
      sum.derivative.col(step_.variable) += factor * step_power_slope(power) * term.value;
    }
  }
}

void ProgramGraph::evaluate_call(Node& call, bool with_derivatives) {
  call.inputs.resize(call.function->num_inputs());
  Index row = 0;
  for (const Term& input : call.terms) {
    const VectorXd& value = node(input.vector).value;
    call.inputs.segment(row, value.size()) = value;
    row += value.size();
  }
  if (!with_derivatives) {
    call.function->evaluate(call.inputs, call.value);
    return;
  }
  call.function->evaluate_with_derivatives(call.inputs, call.value, call.slope);
  call.derivative.setZero(call.size, num_locals_);
  if (call.is_direct) {
    call.derivative(Eigen::all, call.active) = call.slope;
  } else {
    call.derivative(Eigen::all, call.active) = call.slope * gathered(call);
  }
}

MatrixXd ProgramGraph::gathered(const Node& call) const {
  MatrixXd result(call.function->num_inputs(), static_cast<Index>(call.active.size()));
  Index row = 0;
  for (const Term& input : call.terms) {
    const MatrixXd& derivative = node(input.vector).derivative;
    result.middleRows(row, derivative.rows()) = derivative(Eigen::all, call.active);
    row += derivative.rows();
  }
  return result;
}

void ProgramGraph::clear_weights() {
  for (Node& node : nodes_) node.weights.setZero(node.size);
}

void ProgramGraph::add_hessian(MatrixXd& result) {
  for (auto it = nodes_.rbegin(); it != nodes_.rend(); ++it) {
    if (it->kind == Kind::slice) {
      node(it->terms.front().vector).weights.segment(it->first, it->size) += it->weights;
    } else if (it->kind == Kind::sum) {
      pull_back_sum(*it, result);
    } else if (it->kind == Kind::call) {
      pull_back_call(*it, result);
    }
  }
}

void ProgramGraph::pull_back_sum(const Node& sum, MatrixXd& result) {
  const int T = step_.variable;
  for (const auto& [factor, power, vector] : sum.terms) {
    Node& term = node(vector);
    term.weights += factor * step_power(power) * sum.weights;
    if (power == 0 || T < 0) continue;
    const VectorXd on_locals = factor * step_power_slope(power) * (term.derivative.transpose() * sum.weights);
    result.row(T) += on_locals.transpose();
    result.col(T) += on_locals;
    if (power == 1) continue;
    const double bend = power * (power - 1) * step_.share * step_.share * step_power(power - 2);
    result(T, T) += factor * bend * sum.weights.dot(term.value);
  }
}

void ProgramGraph::pull_back_call(Node& call, MatrixXd& result) {
  if (call.weights.isZero(0.0)) return;
  MatrixXd inner;
  call.function->hessian(call.inputs, call.weights, inner);
  if (call.is_direct) {
    result(call.active, call.active) += inner;
  } else {
    const MatrixXd slope = gathered(call);
    result(call.active, call.active) += slope.transpose() * (inner * slope);
  }
  const VectorXd on_inputs = call.slope.transpose() * call.weights;
  Index row = 0;
  for (const Term& input : call.terms) {
    Node& of = node(input.vector);
    of.weights += on_inputs.segment(row, of.size);
    row += of.size;
  }
}

}  // namespace prowl

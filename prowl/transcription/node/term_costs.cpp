#include "prowl/transcription/node/term_costs.hpp"

#include <algorithm>
#include <utility>

namespace prowl {

namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Of each node of the phase: the part of its quadrature weight in intervals at both of whose ends the term holds; for
/// a moment 1 at its node.
std::vector<double> shares_of(const DiscreteProblem& discrete, const TermUse& use, int phase) {
  const PhaseMesh& mesh = discrete.mesh.phases[phase];
  const auto holds = [&](int k) { return discrete.holds(use, phase, k); };
  std::vector<double> shares;
  for (int k = 0; k <= mesh.intervals(); ++k) {
    if (use.is_moment()) {
      shares.push_back(holds(k) ? 1.0 : 0.0);
      continue;
    }
    double inside = 0.0, all = 0.0;
    for (const int i : {k - 1, k}) {
      if (i < 0 || i >= mesh.intervals()) continue;
      const double step = mesh.step(i, 1.0);
      all += step;
      if (holds(i) && holds(i + 1)) inside += step;
    }
    shares.push_back(inside / all);
  }
  return shares;
}

}  // namespace

TermCosts::TermCosts(const DiscreteProblem& discrete, int phase) {
  for (const TermUse& use : discrete.problem.terms) {
    if (!use.is_cost()) continue;
    std::vector<double> shares = shares_of(discrete, use, phase);
    if (std::ranges::all_of(shares, [](double share) { return share == 0.0; })) continue;
    const MotionProblem& problem = discrete.problem;
    costs_.push_back({TermEvaluation(problem.robot, use, contact_indices(problem.phases[phase].contacts)), use.weight,
                      use.reference, use.is_moment(), std::move(shares), VectorXd(use.reference.size())});
  }
}

double TermCosts::weight_at(const Cost& cost, const NodePoint& point) {
  const double share = cost.shares[point.node];
  return cost.is_moment ? share : share * point.cost_weight;
}

TermCosts::Value TermCosts::value(const NodePoint& point, const NodeReading& at_node) {
  Value value;
  for (Cost& cost : costs_) {
    const double factor = weight_at(cost, point);
    if (factor == 0.0) continue;
    cost.at_node.evaluate(at_node);
    cost.error = cost.at_node.value() - cost.reference;
    cost.pull.noalias() = cost.weight * cost.error;
    (cost.is_moment ? value.at_moment : value.running) += 0.5 * factor * cost.pull.dot(cost.error);
  }
  return value;
}

void TermCosts::add_gradient(const NodePoint& point, const MatrixXd& forces_dx, VectorXd& gradient, VectorXd& running) {
  for (Cost& cost : costs_) {
    const double factor = weight_at(cost, point);
    if (factor == 0.0) continue;
    cost.at_node.differentiate(forces_dx);
    const MatrixXd& dx = cost.at_node.dx();
    const auto add = [&](VectorXd& result) {
      result.segment(cost.at_node.first_variable(), dx.cols()).noalias() += factor * (dx.transpose() * cost.pull);
    };
    add(gradient);
    if (!cost.is_moment) add(running);
  }
}

void TermCosts::add_hessian(const NodePoint& point, double factor, MatrixXd& result) {
  for (Cost& cost : costs_) {
    const double of_node = factor * weight_at(cost, point);
    if (of_node == 0.0) continue;
    const MatrixXd& dx = cost.at_node.dx();
    cost.weighted.noalias() = cost.weight * dx;
    cost.weighted *= of_node;
    const Eigen::Index first = cost.at_node.first_variable();
    result.block(first, first, dx.cols(), dx.cols()).noalias() += dx.transpose() * cost.weighted;
    cost.weighted_pull = of_node * cost.pull;
    cost.at_node.add_hessian(cost.weighted_pull, result);
  }
}

void TermCosts::add_force_pull(const NodePoint& point, double factor, VectorXd& pull) {
  for (Cost& cost : costs_) {
    const double of_node = factor * weight_at(cost, point);
    if (of_node == 0.0) continue;
    cost.weighted_pull = of_node * cost.pull;
    cost.at_node.add_force_pull(cost.weighted_pull, pull);
  }
}

}  // namespace prowl

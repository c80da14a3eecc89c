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
  const auto holds = [&](int k) { return use.holds_at(phase, mesh.node_time(k, 1.0)); };
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
    costs_.push_back({TermEvaluation(discrete.problem.robot, use), use.weight, use.reference, use.is_moment(),
                      std::move(shares), VectorXd(use.weight.size())});
  }
}

double TermCosts::weight_at(const Cost& cost, const NodePoint& point) {
  const double share = cost.shares[point.node];
  return cost.is_moment ? share : share * point.cost_weight;
}

TermCosts::Value TermCosts::value(const NodePoint& point, const RigidBodyTerms& kinematics) {
  Value value;
  for (Cost& cost : costs_) {
    const double factor = weight_at(cost, point);
    if (factor == 0.0) continue;
    cost.at_node.evaluate(kinematics, point.q, point.v);
    const VectorXd& f = cost.at_node.value();
    cost.pull = cost.weight.cwiseProduct(f - cost.reference);
    (cost.is_moment ? value.at_moment : value.running) += 0.5 * factor * cost.pull.dot(f - cost.reference);
  }
  return value;
}

void TermCosts::add_gradient(const NodePoint& point, VectorXd& gradient, VectorXd& running) {
  for (Cost& cost : costs_) {
    const double factor = weight_at(cost, point);
    if (factor == 0.0) continue;
    cost.at_node.differentiate();
    const Eigen::Index nv = point.v.size();
    const auto add = [&](VectorXd& result) {
      result.head(nv).noalias() += factor * (cost.at_node.dq().transpose() * cost.pull);
      if (cost.at_node.reads_rates()) {
        result.segment(nv, nv).noalias() += factor * (cost.at_node.dv().transpose() * cost.pull);
      }
    };
    add(gradient);
    if (!cost.is_moment) add(running);
  }
}

void TermCosts::add_hessian(const NodePoint& point, double factor, MatrixXd& result) {
  const Eigen::Index nv = point.v.size();
  auto qq = result.topLeftCorner(nv, nv), vq = result.block(nv, 0, nv, nv), vv = result.block(nv, nv, nv, nv);
  for (Cost& cost : costs_) {
    const double of_node = factor * weight_at(cost, point);
    if (of_node == 0.0) continue;
    const MatrixXd &dq = cost.at_node.dq(), &dv = cost.at_node.dv();
    cost.weighted.noalias() = of_node * cost.weight.asDiagonal() * dq;
    qq.noalias() += dq.transpose() * cost.weighted;
    if (cost.at_node.reads_rates()) {
      vq.noalias() += dv.transpose() * cost.weighted;
      cost.weighted.noalias() = of_node * cost.weight.asDiagonal() * dv;
      vv.noalias() += dv.transpose() * cost.weighted;
    }
    cost.weighted_pull = of_node * cost.pull;
    cost.at_node.add_hessian(cost.weighted_pull, qq, vq, vv);
  }
}

}  // namespace prowl

#include "prowl/transcription/node/term_rows.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {

namespace {

/// Whether the term is a limit at this node of a phase, and not determined by the start or by the node before.
bool is_row_at(const DiscreteProblem& discrete, const TermUse& use, int phase, int node) {
  const PhaseMesh& mesh = discrete.mesh.phases[phase];
  if (!use.holds_at(phase, mesh.node_time(node, 1.0))) return false;
  if (node > 0) return true;
  if (phase > 0) return !use.holds_at(phase - 1, 1.0);
  const BoundaryConstraint& start = discrete.problem.start();
  return !start.fixes_configuration() || (reads_rates(*use.term) && !start.fixes_velocity());
}

}  // namespace

TermRows::TermRows(const DiscreteProblem& discrete, int phase) {
  const MotionProblem& problem = discrete.problem;
  rows_.resize(discrete.mesh.phases[phase].intervals() + 1);
  for (const TermUse& use : problem.terms) {
    if (use.is_cost()) continue;
    const double size = natural_size(problem.robot, use.term->unit());
    const double room = use.is_moment() ? 0.0 : 0.5 * term_tolerance(problem.goal_tolerance, use.term->unit());
    bool is_used = false;
    for (int k = 0; k < static_cast<int>(rows_.size()); ++k) {
      if (!is_row_at(discrete, use, phase, k)) continue;
      for (int row = 0; row < use.term->num_rows(); ++row) {
        const double lower = use.lower(row), upper = use.upper(row);
        if (!std::isfinite(lower) && !std::isfinite(upper)) continue;
        const double widened = std::max(0.0, room - 0.5 * (upper - lower));
        rows_[k].push_back({static_cast<int>(terms_.size()), row, (lower - widened) / size, (upper + widened) / size});
        is_used = true;
      }
    }
    if (!is_used) continue;
    terms_.push_back({TermEvaluation(problem.robot, use), use.name, use.is_moment(), use.term->unit(), use.term->rows(),
                      size, Eigen::VectorXd::Zero(use.term->num_rows())});
  }
}

int TermRows::most_rows() const {
  std::size_t most = 0;
  for (const std::vector<Row>& rows : rows_) most = std::max(most, rows.size());
  return static_cast<int>(most);
}

std::string TermRows::describe(int k, int row) const {
  const Limit& term = terms_[at(k, row).term];
  return "term '" + term.name + "', " + term.rows[at(k, row).row];
}

MotionLimit TermRows::limit(int k, int row) const {
  const Limit& term = terms_[at(k, row).term];
  return {.kind = LimitKind::term,
          .is_moment = term.is_moment,
          .subject = describe(k, row),
          .unit = term.unit,
          .si = term.size,
          .size = term.size};
}

template <class Each>
void TermRows::for_each_term(int k, const Each& each) {
  int first = 0;
  while (first < count(k)) {
    int next = first;
    while (next < count(k) && at(k, next).term == at(k, first).term) ++next;
    each(terms_[at(k, first).term], first, next - first);
    first = next;
  }
}

void TermRows::evaluate(int k, const RigidBodyTerms& kinematics, const Eigen::VectorXd& q, const Eigen::VectorXd& v,
                        Eigen::Ref<Eigen::VectorXd> values) {
  for_each_term(k, [&](Limit& term, int first, int count) {
    term.at_node.evaluate(kinematics, q, v);
    for (int row = first; row < first + count; ++row) values(row) = term.at_node.value()(at(k, row).row) / term.size;
  });
}

void TermRows::derivatives(int k, Eigen::Ref<Eigen::MatrixXd> dq, Eigen::Ref<Eigen::MatrixXd> dv) {
  for_each_term(k, [&](Limit& term, int first, int count) {
    term.at_node.differentiate();
    for (int row = first; row < first + count; ++row) {
      dq.row(row) = term.at_node.dq().row(at(k, row).row) / term.size;
      dv.row(row) = term.at_node.dv().row(at(k, row).row) / term.size;
    }
  });
}

void TermRows::add_hessian(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, Eigen::Ref<Eigen::MatrixXd> qq,
                           Eigen::Ref<Eigen::MatrixXd> vq, Eigen::Ref<Eigen::MatrixXd> vv) {
  for_each_term(k, [&](Limit& term, int first, int count) {
    term.multipliers.setZero();
    for (int row = first; row < first + count; ++row) term.multipliers(at(k, row).row) = multipliers(row) / term.size;
    term.at_node.add_hessian(term.multipliers, qq, vq, vv);
  });
}

}  // namespace prowl

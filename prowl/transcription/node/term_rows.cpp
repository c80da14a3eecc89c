#include "prowl/transcription/node/term_rows.hpp"

#include <algorithm>
#include <cmath>

namespace prowl {

namespace {

/// Whether the term is a limit at this node of a phase, and not determined by the start or by the node before.
bool is_row_at(const DiscreteProblem& discrete, const TermUse& use, int phase, int node) {
  if (!discrete.holds(use, phase, node)) return false;
  if (node > 0 || reads_loads(*use.term)) return true;
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
    const double size = natural_size(problem.robot, *use.term);
    const double room = use.is_moment() ? 0.0 : 0.5 * term_tolerance(problem, *use.term);
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
    terms_.push_back({use, TermEvaluation(problem.robot, use, contact_indices(problem.phases[phase].contacts)), size,
                      Eigen::VectorXd::Zero(use.term->num_rows())});
  }
}

int TermRows::most_rows() const {
  std::size_t most = 0;
  for (const std::vector<Row>& rows : rows_) most = std::max(most, rows.size());
  return static_cast<int>(most);
}

std::string TermRows::describe(int k, int row) const {
  const TermUse& use = terms_[at(k, row).term].use;
  return "term '" + use.name + "', " + use.term->rows()[at(k, row).row];
}

MotionLimit TermRows::limit(int k, int row) const {
  const Limit& term = terms_[at(k, row).term];
  return {.kind = LimitKind::term,
          .is_moment = term.use.is_moment(),
          .subject = describe(k, row),
          .unit = term.use.term->unit(),
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

template <class Each>
void TermRows::for_each_multiplied(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, const Each& each) {
  for_each_term(k, [&](Limit& term, int first, int count) {
    term.multipliers.setZero();
    for (int row = first; row < first + count; ++row) term.multipliers(at(k, row).row) = multipliers(row) / term.size;
    each(term.at_node, term.multipliers);
  });
}

void TermRows::evaluate(int k, const NodeReading& at_node, Eigen::Ref<Eigen::VectorXd> values) {
  for_each_term(k, [&](Limit& term, int first, int count) {
    term.at_node.evaluate(at_node);
    for (int row = first; row < first + count; ++row) values(row) = term.at_node.value()(at(k, row).row) / term.size;
  });
}

void TermRows::derivatives(int k, const Eigen::MatrixXd& forces_dx, Eigen::Ref<Eigen::MatrixXd> dx) {
  for_each_term(k, [&](Limit& term, int first, int count) {
    term.at_node.differentiate(forces_dx);
    const Eigen::MatrixXd& of_term = term.at_node.dx();
    for (int row = first; row < first + count; ++row) {
      dx.row(row).segment(term.at_node.first_variable(), of_term.cols()) = of_term.row(at(k, row).row) / term.size;
    }
  });
}

void TermRows::add_hessian(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers,
                           Eigen::Ref<Eigen::MatrixXd> hessian) {
  for_each_multiplied(k, multipliers, [&](TermEvaluation& term, const Eigen::VectorXd& of_term) {
    term.add_hessian(of_term, hessian);
  });
}

void TermRows::add_force_pull(int k, const Eigen::Ref<const Eigen::VectorXd>& multipliers, Eigen::VectorXd& pull) {
  for_each_multiplied(k, multipliers, [&](TermEvaluation& term, const Eigen::VectorXd& of_term) {
    term.add_force_pull(of_term, pull);
  });
}

}  // namespace prowl

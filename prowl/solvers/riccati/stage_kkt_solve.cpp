// StageKkt::solve() and its sweeps, with the factors of stage_kkt.cpp.
#include <algorithm>
#include <limits>

#include "prowl/solvers/riccati/stage_kkt.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr int kMostRefinements = 5;
constexpr double kRefined = 1e-12;  ///< residual relative to the right-hand sides; refinement stops here

void add(double factor, const StageVectors& from, StageVectors& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

}  // namespace

void StageKkt::solve(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links,
                     double accuracy) {
  solve_once(gradient, equalities, links);
  // Large weights cost digits of the other curvature.
  const bool weighs_little = largest(weights_) * std::numeric_limits<double>::epsilon() <= accuracy;
  if (left_out() <= accuracy && weighs_little) return;
  sum_.steps = steps_;
  sum_.on_equalities = on_equalities_;
  sum_.on_next = on_next_;
  sum_.along_inequalities = along_inequalities_;
  const double rounding = kRefined * std::max({largest(gradient), largest(equalities), largest(links)});
  double last = std::numeric_limits<double>::infinity();
  const auto add_correction = [this](double factor) {
    add(factor, steps_, sum_.steps);
    add(factor, on_equalities_, sum_.on_equalities);
    add(factor, on_next_, sum_.on_next);
    add(factor, along_inequalities_, sum_.along_inequalities);
  };
  for (int i = 0;; ++i) {
    const double residual = find_residual(gradient, equalities, links);
    if (!(residual < last)) add_correction(-1.0);  // undo: it increased the residual
    if (!(residual > std::max(accuracy, rounding)) || !(residual <= 0.5 * last) || i == kMostRefinements) break;
    last = residual;
    solve_once(residual_gradient_, residual_equalities_, residual_links_);
    add_correction(1.0);
  }
  steps_ = sum_.steps;
  on_equalities_ = sum_.on_equalities;
  on_next_ = sum_.on_next;
  along_inequalities_ = sum_.along_inequalities;
}

/// A bound on the residual by coefficients that determine_inputs() neglects.
double StageKkt::left_out() const {
  if (neglected_ == 0.0) return 0.0;
  double largest_sum = 0.0;
  for (int k = 0; k < num_stages_; ++k) {
    largest_sum = std::max({largest_sum, steps_[k].lpNorm<1>(), stages_[k].on_rows.lpNorm<1>()});
  }
  return neglected_ * largest_sum;
}

/// Residual of the equations at the sum of the solutions so far.
double StageKkt::find_residual(const StageVectors& gradient, const StageVectors& equalities,
                               const StageVectors& links) {
  residual_gradient_ = gradient;
  residual_equalities_ = equalities;
  residual_links_ = links;
  for (int k = 0; k < num_stages_; ++k) {
    const VectorXd& step = sum_.steps[k];
    VectorXd& violation = residual_gradient_[k];
    if (hessian_ == Hessian::lagrangian) {
      violation.noalias() += chain_.lagrangian_hessian(k).selfadjointView<Eigen::Lower>() * step;
    }
    violation += delta_ * step;
    violation.noalias() += chain_.equality_slopes(k).transpose() * sum_.on_equalities[k];
    if (k == 0 && num_closing() > 0)
      violation.noalias() += chain_.closure().transpose() * sum_.on_equalities.back().tail(num_closing());
    residual_inequalities_[k] = weights_[k].cwiseProduct(sum_.along_inequalities[k]);
    chain_.add_pull_back(k, sum_.on_next[k], residual_inequalities_[k], violation);
    if (k > 0) violation.tail(stage(k).size.states) -= sum_.on_next[k - 1];
    residual_equalities_[k].noalias() += chain_.equality_slopes(k) * step;
    if (k + 1 == num_stages_ && num_closing() > 0)
      residual_equalities_[k].tail(num_closing()).noalias() += chain_.closure() * sum_.steps.front();
    if (k + 1 == num_stages_) continue;
    VectorXd& next = residual_next_[k];
    chain_.push_forward(k, step, next, residual_inequalities_[k]);
    residual_links_[k] += next - sum_.steps[k + 1].tail(next.size());
  }
  return std::max({largest(residual_gradient_), largest(residual_equalities_), largest(residual_links_)});
}

/// The chain without its closing equalities c; their multipliers m; and the chain again, with these.
void StageKkt::solve_once(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links) {
  const Index closing = num_closing();
  solve_chain(gradient, equalities, links);
  if (closing == 0) return;
  const VectorXd multipliers = closing_.solve(along_closure() + equalities.back().tail(closing));
  StageVectors pulled = gradient;
  pull_back_closure(multipliers, pulled);
  solve_chain(pulled, equalities, links);
  on_equalities_.back().tail(closing) = multipliers;
}

VectorXd StageKkt::along_closure() const {
  return chain_.closure() * steps_.front() +
         chain_.equality_slopes(num_stages_ - 1).bottomRows(num_closing()) * steps_.back();
}

void StageKkt::pull_back_closure(const VectorXd& multipliers, StageVectors& gradient) const {
  gradient.front().noalias() += chain_.closure().transpose() * multipliers;
  gradient.back().noalias() +=
      chain_.equality_slopes(num_stages_ - 1).bottomRows(num_closing()).transpose() * multipliers;
}

/// Column by column, by the step that one multiplier causes. False if the closed chain has a negative curvature.
bool StageKkt::factorise_closure() {
  StageVectors none = steps_, no_equalities = on_equalities_, no_links = on_next_;
  for (StageVectors* vectors : {&none, &no_equalities, &no_links}) {
    for (VectorXd& vector : *vectors) vector.setZero();
  }
  Eigen::MatrixXd responses(num_closing(), num_closing());
  for (Index i = 0; i < num_closing(); ++i) {
    StageVectors gradient = none;
    pull_back_closure(VectorXd::Unit(num_closing(), i), gradient);
    solve_chain(gradient, no_equalities, no_links);
    responses.col(i) = -along_closure();
  }
  if (!responses.allFinite()) return false;
  closing_.compute(responses);
  // Haynsworth: each negative curvature of the open chain must be one that an equality excludes.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> shapes(responses, Eigen::EigenvaluesOnly);
  return (shapes.eigenvalues().array() < 0.0).count() == num_negative_;
}

void StageKkt::solve_chain(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links) {
  sweep_back(num_stages_, gradient, equalities, links);
  sweep_ahead(0, num_stages_, links);
}

void StageKkt::sweep_back(int stages, const StageVectors& gradient, const StageVectors& equalities,
                          const StageVectors& links) {
  for (int k = stages - 1; k >= 0; --k) backward(k, gradient[k], equalities[k], link_of(k, links));
}

void StageKkt::sweep_ahead(int begin, int end, const StageVectors& links) {
  for (int k = begin; k < end; ++k) forward(k, link_of(k, links));
}

void StageKkt::backward(int k, const VectorXd& gradient, const VectorXd& equalities, const VectorXd* link) {
  Stage& s = stage(k);
  const int rank = s.rank, states = s.size.states;
  s.gradient = gradient;
  s.c.resize(s.num_equalities());
  s.on_rows.resize(s.num_equalities());
  s.c.head(s.size.equalities) = equalities.head(s.size.equalities);
  if (link) {
    const Stage& next = stage(k + 1);
    VectorXd& on_next = on_next_[k];
    on_next = next.p;
    on_next.noalias() += next.P * *link;
    chain_.add_pull_back(k, on_next, nothing_, s.gradient);
    if (s.carried > 0) {
      s.c.tail(s.carried) = next.e;
      s.c.tail(s.carried).noalias() += next.E * *link;
    }
  }
  s.m.resize(s.gradient.size());
  for (Index i = 0; i < s.m.size(); ++i) s.m(i) = s.gradient(s.order[i]);

  s.r = s.m.tail(s.rest());
  if (rank > 0) {
    for (Index i = 0; i < s.c.size(); ++i) s.on_rows(i) = s.c(s.rows[i]);
    s.c.swap(s.on_rows);
    const auto square = s.lu.topRows(rank);
    auto determining = s.c.head(rank);
    square.triangularView<Eigen::UnitLower>().solveInPlace(determining);
    const Index left = s.c.size() - rank;
    s.c.tail(left).noalias() -= s.lu.bottomRows(left) * determining;
    s.k = -determining;
    square.triangularView<Eigen::Upper>().solveInPlace(s.k);
    s.r.noalias() += s.K * s.m.head(rank);
    s.r.noalias() += s.T * s.k;
  }
  s.e.resize(s.passed);
  for (int i = 0; i < s.passed; ++i) s.e(i) = s.c(s.passed_rows[i]);
  s.p = s.r.tail(states);
  if (s.free() > 0) {
    auto free = s.r.head(s.free());
    if (s.signs.size() == 0) {
      s.L.triangularView<Eigen::Lower>().solveInPlace(free);
    } else {
      free = s.signs.cwiseProduct(s.inverse_L * free).eval();
    }
    s.p.noalias() -= s.G * free;
  }
}

void StageKkt::forward(int k, const VectorXd* link) {
  Stage& s = stage(k);
  VectorXd& step = steps_[k];
  if (k == 0) s.on_carried.setZero(s.passed);  // nothing comes before a given start
  s.step.resize(step.size());
  s.step.tail(s.size.states) = step.tail(s.size.states);
  if (s.free() > 0) {
    auto free = s.step.segment(s.rank, s.free());
    free = -s.r.head(s.free());
    if (s.signs.size() == 0) {
      free.noalias() -= s.G.transpose() * s.step.tail(s.size.states);
      s.L.triangularView<Eigen::Lower>().transpose().solveInPlace(free);
    } else {
      free -= s.signs.cwiseProduct(s.G.transpose() * s.step.tail(s.size.states));
      free = (s.inverse_L.transpose() * free).eval();
    }
  }
  if (s.rank > 0) {
    s.step.head(s.rank) = s.k;
    s.step.head(s.rank).noalias() += s.K.transpose() * s.step.tail(s.rest());
  }
  for (Index i = 0; i < step.size(); ++i) step(s.order[i]) = s.step(i);

  find_multipliers(k);
  chain_.push_forward(k, step, on_next_[k], along_inequalities_[k]);
  if (!link) return;
  Stage& next = stage(k + 1);
  auto dx = steps_[k + 1].tail(next.size.states);
  dx = on_next_[k] + *link;
  on_next_[k] = next.p;
  on_next_[k].noalias() += next.P * dx;
  if (s.carried > 0) on_next_[k].noalias() += next.E.transpose() * next.on_carried;
}

void StageKkt::input_gain(int k, Eigen::Ref<Eigen::MatrixXd> gain) {
  const Stage& s = stage(k);
  const int free = s.free(), states = s.size.states;
  free_gain_ = -s.G.transpose();
  if (free > 0) s.L.triangularView<Eigen::Lower>().transpose().solveInPlace(free_gain_);
  determined_gain_ = s.K.bottomRows(states).transpose();
  determined_gain_.noalias() += s.K.topRows(free).transpose() * free_gain_;
  for (int i = 0; i < s.size.inputs; ++i)
    gain.row(s.order[i]) = i < s.rank ? determined_gain_.row(i) : free_gain_.row(i - s.rank);
}

/// From the gradient in the determined inputs: M_dd k + T r + m + equalities' multipliers = 0. The
/// stage before has set the multipliers of the conditions on the state.
void StageKkt::find_multipliers(int k) {
  Stage& s = stage(k);
  const int rank = s.rank;
  s.on_rows.setZero(s.num_equalities());
  for (int i = 0; i < s.passed; ++i) s.on_rows(s.passed_rows[i]) = s.on_carried(i);
  if (rank > 0) {
    const auto square = s.lu.topRows(rank);
    const Index left = s.on_rows.size() - rank;
    auto on_determining = s.on_rows.head(rank);
    on_determining = -s.m.head(rank);
    on_determining.noalias() -= s.M_dd * s.k;
    on_determining.noalias() -= s.T.transpose() * s.step.tail(s.rest());
    square.triangularView<Eigen::Upper>().transpose().solveInPlace(on_determining);
    on_determining.noalias() -= s.lu.bottomRows(left).transpose() * s.on_rows.tail(left);
    square.triangularView<Eigen::UnitLower>().transpose().solveInPlace(on_determining);
  }
  s.c.resize(s.on_rows.size());
  for (Index i = 0; i < s.on_rows.size(); ++i) s.c(s.rows[i]) = s.on_rows(i);
  s.on_rows.swap(s.c);
  on_equalities_[k].head(s.size.equalities) = s.on_rows.head(s.size.equalities);
  if (s.carried > 0) stage(k + 1).on_carried = s.on_rows.tail(s.carried);
}

}  // namespace prowl

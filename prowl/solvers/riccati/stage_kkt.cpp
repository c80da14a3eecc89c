#include "prowl/solvers/riccati/stage_kkt.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The remainder of an equality counts above this fraction of the largest entry. At a landing,
/// position and velocity of the foot constrain one acceleration of a stage. Their difference is of
/// third order in the step, 1e-9 on fine meshes; using it gives multipliers of 1e12 (HyQ trot, 624
/// intervals). An independent condition on a position leaves the square of the step, 1e-5.
constexpr double kDependent = 1e-7;
/// Smaller pivots are rounding.
constexpr double kPivotRounding = 1e-12;

constexpr int kMostRefinements = 5;
constexpr double kRefined = 1e-12;  ///< residual relative to the right-hand sides; refinement stops here

void add(double factor, const StageVectors& from, StageVectors& to) {
  for (std::size_t i = 0; i < to.size(); ++i) to[i] += factor * from[i];
}

}  // namespace

StageKkt::StageKkt(StagewiseNlp& nlp) : nlp_(nlp), num_stages_(nlp.num_stages()) {
  stages_.resize(static_cast<std::size_t>(num_stages_));
  for (int k = 0; k < num_stages_; ++k) {
    Stage& s = stage(k);
    s.size = nlp.size(k);
    if (k == 0)
      s.size = {s.size.variables(), 0, s.size.equalities, s.size.inequalities};  // no stage leads to these states
    const int variables = s.size.variables(), next = k + 1 < num_stages_ ? nlp.size(k + 1).states : 0;
    for (int i = 0; i < variables; ++i) s.order.push_back(i);
    s.P.setZero(s.size.states, s.size.states);
    s.p.setZero(s.size.states);
    s.no_inequalities.setZero(s.size.inequalities);
    steps_.push_back(VectorXd::Zero(variables));
    on_equalities_.push_back(VectorXd::Zero(s.size.equalities));
    on_next_.push_back(VectorXd::Zero(next));
    along_inequalities_.push_back(VectorXd::Zero(s.size.inequalities));
  }
  residual_next_ = on_next_;
  residual_inequalities_ = along_inequalities_;
}

StageKkt::Outcome StageKkt::factorise(Hessian hessian, double delta, const StageVectors& weights) {
  is_exact_ = true;
  hessian_ = hessian;
  delta_ = delta;
  weights_ = weights;
  for (int k = num_stages_ - 1; k >= 0; --k) {
    last_stage_ = k;
    const Outcome outcome = factorise_stage(k);
    if (outcome != Outcome::solvable) return outcome;
  }
  return Outcome::solvable;
}

MatrixXd& StageKkt::Shared::of_size(Index rows, Index cols) {
  const auto has_size = [&](const MatrixXd& matrix) { return matrix.rows() == rows && matrix.cols() == cols; };
  const auto found = std::ranges::find_if(matrices_, has_size);
  return found != matrices_.end() ? *found : matrices_.emplace_back(rows, cols);
}

StageKkt::Outcome StageKkt::factorise_stage(int k) {
  Stage& s = stage(k);
  const int variables = s.size.variables(), states = s.size.states;
  const MatrixXd& equalities = gather_equalities(k);
  if (!equalities.allFinite()) return Outcome::not_finite;
  determine_inputs(s, equalities);
  MatrixXd& condensed = work_.condensed.of_size(variables, variables);
  nlp_.condense(k, k + 1 < num_stages_ ? stage(k + 1).P : no_hessian_, weights_[k], condensed);
  if (hessian_ == Hessian::lagrangian) condensed += nlp_.lagrangian_hessian(k);
  condensed.diagonal().array() += delta_;
  if (!condensed.allFinite()) return Outcome::not_finite;
  MatrixXd& M = work_.M.of_size(variables, variables);
  put_in_order(s, condensed, M);
  MatrixXd& N = work_.N.of_size(s.rest(), s.rest());
  MatrixXd& in_states = work_.in_states.of_size(s.num_equalities(), states);
  eliminate(s, equalities, M, in_states, N);
  pass_conditions(s, equalities, in_states);

  const int free = s.free();
  s.P = N.bottomRightCorner(states, states);
  if (free > 0) {
    s.cholesky.compute(N.topLeftCorner(free, free));
    if (s.cholesky.info() != Eigen::Success || !s.cholesky.matrixLLT().diagonal().allFinite())
      return Outcome::indefinite;
    s.G = N.bottomLeftCorner(states, free).transpose();
    if (states > 0) {  // Eigen's triangular solve fails on empty matrices
      s.cholesky.matrixL().solveInPlace(s.G);
      s.P.selfadjointView<Eigen::Lower>().rankUpdate(s.G.transpose(), -1.0);
    }
  }
  s.P.triangularView<Eigen::StrictlyUpper>() = s.P.transpose();
  return s.P.allFinite() ? Outcome::solvable : Outcome::indefinite;
}

/// Own equalities and those on the next stage's state.
MatrixXd& StageKkt::gather_equalities(int k) {
  Stage& s = stage(k);
  s.carried = k + 1 < num_stages_ ? stage(k + 1).passed : 0;
  MatrixXd& equalities = work_.equalities.of_size(s.num_equalities(), s.size.variables());
  equalities.topRows(s.size.equalities) = nlp_.equality_slopes(k);
  for (int i = 0; i < s.carried; ++i) {
    VectorXd& on_next = on_next_[k];
    on_next = stage(k + 1).E.row(i).transpose();
    s.gradient.setZero(s.size.variables());
    nlp_.add_pull_back(k, on_next, s.no_inequalities, s.gradient);
    equalities.row(s.size.equalities + i) = s.gradient.transpose();
  }
  return equalities;
}

template <class Pivots>
int StageKkt::count_independent(const MatrixXd& equalities, const Pivots& pivots) {
  const double scale = equalities.cwiseAbs().maxCoeff();
  int count = 0;
  while (count < pivots.size() && std::abs(pivots(count)) > kDependent * scale) ++count;
  is_exact_ = is_exact_ && (count == pivots.size() || std::abs(pivots(count)) < kPivotRounding * scale);
  return count;
}

void StageKkt::determine_inputs(Stage& s, const MatrixXd& equalities) {
  s.rank = 0;
  if (s.num_equalities() == 0 || s.size.inputs == 0) return;
  s.lu.compute(equalities.leftCols(s.size.inputs));
  s.rank = count_independent(equalities, s.lu.matrixLU().diagonal());
  for (int i = 0; i < s.size.inputs; ++i) s.order[i] = s.lu.permutationQ().indices()(i);
}

/// M with permuted inputs. Fills the lower triangle, and the whole block of the inputs.
void StageKkt::put_in_order(const Stage& s, const MatrixXd& condensed, MatrixXd& M) {
  const int inputs = s.size.inputs, states = s.size.states;
  for (int j = 0; j < inputs; ++j) {
    const auto from = condensed.col(s.order[j]);
    for (int i = 0; i < inputs; ++i) M(i, j) = from(s.order[i]);
    M.col(j).tail(states) = from.tail(states);
  }
  M.bottomRightCorner(states, states) = condensed.bottomRightCorner(states, states);
}

/// M in the remaining variables: N = M_rr + M_rd K + K' M_dr + K' M_dd K.
void StageKkt::eliminate(Stage& s, const MatrixXd& equalities, const MatrixXd& M, MatrixXd& in_states, MatrixXd& N) {
  const int rank = s.rank, rest = s.rest(), states = s.size.states;
  in_states = equalities.rightCols(states);
  N.triangularView<Eigen::Lower>() = M.bottomRightCorner(rest, rest);
  if (rank == 0) return;
  const auto lu = s.lu.matrixLU().topLeftCorner(rank, rank);
  auto determining = in_states.topRows(rank);
  if (states > 0) {
    in_states.noalias() = s.lu.permutationP() * equalities.rightCols(states);
    lu.triangularView<Eigen::UnitLower>().solveInPlace(determining);
  }
  const Index left = in_states.rows() - rank;
  in_states.bottomRows(left).noalias() -= s.lu.matrixLU().bottomLeftCorner(left, rank) * determining;
  s.K.resize(rank, rest);
  s.K.leftCols(s.free()) = -s.lu.matrixLU().topRightCorner(rank, s.free());
  s.K.rightCols(states) = -determining;
  if (rest > 0) lu.triangularView<Eigen::Upper>().solveInPlace(s.K);

  s.M_dd = M.topLeftCorner(rank, rank);
  MatrixXd& M_ddK = work_.M_ddK.of_size(rank, rest);
  M_ddK.noalias() = s.M_dd * s.K;
  s.T = M.bottomLeftCorner(rest, rank).transpose() + 0.5 * M_ddK;
  if (rest == 0) return;  // Eigen's triangular product of empty matrices divides by zero
  N.triangularView<Eigen::Lower>() += s.T.transpose() * s.K;
  N.triangularView<Eigen::Lower>() += s.K.transpose() * s.T;
  s.T += 0.5 * M_ddK;
}

/// Independent conditions on the state: from equalities that determine no input.
void StageKkt::pass_conditions(Stage& s, const MatrixXd& equalities, const MatrixXd& in_states) {
  s.passed_rows.clear();
  s.passed = 0;
  const int left = s.num_equalities() - s.rank;
  if (left == 0 || s.size.states == 0) return;
  const auto& qr = s.conditions.compute(in_states.bottomRows(left).transpose());
  s.passed = count_independent(equalities, qr.matrixQR().diagonal());
  s.E.resize(s.passed, s.size.states);
  for (int i = 0; i < s.passed; ++i) {
    s.passed_rows.push_back(s.rank + static_cast<int>(qr.colsPermutation().indices()(i)));
    s.E.row(i) = in_states.row(s.passed_rows.back());
  }
}

void StageKkt::solve(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links,
                     double accuracy) {
  solve_once(gradient, equalities, links);
  // Large weights cost digits of the other curvature.
  const bool weighs_little = largest(weights_) * std::numeric_limits<double>::epsilon() <= accuracy;
  if (is_exact_ && weighs_little) return;
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

/// Residual of the equations at the sum of the solutions so far.
double StageKkt::find_residual(const StageVectors& gradient, const StageVectors& equalities,
                               const StageVectors& links) {
  residual_gradient_ = gradient;
  residual_equalities_ = equalities;
  residual_links_ = links;
  for (int k = 0; k < num_stages_; ++k) {
    const VectorXd& step = sum_.steps[k];
    VectorXd& violation = residual_gradient_[k];
    if (hessian_ == Hessian::lagrangian) violation.noalias() += nlp_.lagrangian_hessian(k) * step;
    violation += delta_ * step;
    violation.noalias() += nlp_.equality_slopes(k).transpose() * sum_.on_equalities[k];
    residual_inequalities_[k] = weights_[k].cwiseProduct(sum_.along_inequalities[k]);
    nlp_.add_pull_back(k, sum_.on_next[k], residual_inequalities_[k], violation);
    if (k > 0) violation.tail(stage(k).size.states) -= sum_.on_next[k - 1];
    residual_equalities_[k].noalias() += nlp_.equality_slopes(k) * step;
    if (k + 1 == num_stages_) continue;
    VectorXd& next = residual_next_[k];
    nlp_.push_forward(k, step, next, residual_inequalities_[k]);
    residual_links_[k] += next - sum_.steps[k + 1].tail(next.size());
  }
  return std::max({largest(residual_gradient_), largest(residual_equalities_), largest(residual_links_)});
}

void StageKkt::solve_once(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links) {
  const auto link = [&](int k) { return k + 1 < num_stages_ ? &links[k] : nullptr; };
  for (int k = num_stages_ - 1; k >= 0; --k) backward(k, gradient[k], equalities[k], link(k));
  for (int k = 0; k < num_stages_; ++k) forward(k, link(k));
}

void StageKkt::backward(int k, const VectorXd& gradient, const VectorXd& equalities, const VectorXd* link) {
  Stage& s = stage(k);
  const int rank = s.rank, states = s.size.states;
  s.gradient = gradient;
  s.c.resize(s.num_equalities());
  s.c.head(s.size.equalities) = equalities;
  if (link) {
    const Stage& next = stage(k + 1);
    VectorXd& on_next = on_next_[k];
    on_next = next.p;
    on_next.noalias() += next.P * *link;
    nlp_.add_pull_back(k, on_next, s.no_inequalities, s.gradient);
    if (s.carried > 0) {
      s.c.tail(s.carried) = next.e;
      s.c.tail(s.carried).noalias() += next.E * *link;
    }
  }
  s.m.resize(s.gradient.size());
  for (Index i = 0; i < s.m.size(); ++i) s.m(i) = s.gradient(s.order[i]);

  s.r = s.m.tail(s.rest());
  if (rank > 0) {
    s.permuted.noalias() = s.lu.permutationP() * s.c;
    s.c.swap(s.permuted);
    const auto lu = s.lu.matrixLU().topLeftCorner(rank, rank);
    auto determining = s.c.head(rank);
    lu.triangularView<Eigen::UnitLower>().solveInPlace(determining);
    const Index left = s.c.size() - rank;
    s.c.tail(left).noalias() -= s.lu.matrixLU().bottomLeftCorner(left, rank) * determining;
    s.k = -determining;
    lu.triangularView<Eigen::Upper>().solveInPlace(s.k);
    s.r.noalias() += s.K.transpose() * s.m.head(rank);
    s.r.noalias() += s.T.transpose() * s.k;
  }
  s.e.resize(s.passed);
  for (int i = 0; i < s.passed; ++i) s.e(i) = s.c(s.passed_rows[i]);
  s.p = s.r.tail(states);
  if (s.free() > 0) {
    auto free = s.r.head(s.free());
    s.cholesky.matrixL().solveInPlace(free);
    s.p.noalias() -= s.G.transpose() * free;
  }
}

void StageKkt::forward(int k, const VectorXd* link) {
  Stage& s = stage(k);
  VectorXd& step = steps_[k];
  s.step.resize(step.size());
  s.step.tail(s.size.states) = step.tail(s.size.states);
  if (s.free() > 0) {
    auto free = s.step.segment(s.rank, s.free());
    free = -s.r.head(s.free());
    free.noalias() -= s.G * s.step.tail(s.size.states);
    s.cholesky.matrixU().solveInPlace(free);
  }
  if (s.rank > 0) {
    s.step.head(s.rank) = s.k;
    s.step.head(s.rank).noalias() += s.K * s.step.tail(s.rest());
  }
  for (Index i = 0; i < step.size(); ++i) step(s.order[i]) = s.step(i);

  find_multipliers(k);
  nlp_.push_forward(k, step, on_next_[k], along_inequalities_[k]);
  if (!link) return;
  Stage& next = stage(k + 1);
  auto dx = steps_[k + 1].tail(next.size.states);
  dx = on_next_[k] + *link;
  on_next_[k] = next.p;
  on_next_[k].noalias() += next.P * dx;
  if (s.carried > 0) on_next_[k].noalias() += next.E.transpose() * next.on_carried;
}

/// From the gradient in the determined inputs: M_dd k + T r + m + equalities' multipliers = 0. The
/// stage before has set the multipliers of the conditions on the state.
void StageKkt::find_multipliers(int k) {
  Stage& s = stage(k);
  const int rank = s.rank;
  s.on_rows.setZero(s.num_equalities());
  for (int i = 0; i < s.passed; ++i) s.on_rows(s.passed_rows[i]) = s.on_carried(i);
  if (rank > 0) {
    const auto lu = s.lu.matrixLU().topLeftCorner(rank, rank);
    const Index left = s.on_rows.size() - rank;
    auto on_determining = s.on_rows.head(rank);
    on_determining = -s.m.head(rank);
    on_determining.noalias() -= s.M_dd * s.k;
    on_determining.noalias() -= s.T * s.step.tail(s.rest());
    lu.triangularView<Eigen::Upper>().transpose().solveInPlace(on_determining);
    on_determining.noalias() -= s.lu.matrixLU().bottomLeftCorner(left, rank).transpose() * s.on_rows.tail(left);
    lu.triangularView<Eigen::UnitLower>().transpose().solveInPlace(on_determining);
    s.permuted.noalias() = s.lu.permutationP().transpose() * s.on_rows;
    s.on_rows.swap(s.permuted);
  }
  on_equalities_[k] = s.on_rows.head(s.size.equalities);
  if (s.carried > 0) stage(k + 1).on_carried = s.on_rows.tail(s.carried);
}

}  // namespace prowl

#include "prowl/solvers/stage_kkt.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Rows count as dependent when what is left of them is below this part of what they were: rounding leaves 1e-13 or less
/// of a contact's goal that follows from the contact itself, and rows that solvers can use leave more than 1e-6.
constexpr double kDependent = 1e-9;

int rank_of(const Eigen::ColPivHouseholderQR<MatrixXd>& qr, double scale) {
  const auto pivots = qr.matrixQR().diagonal();
  int rank = 0;
  while (rank < pivots.size() && std::abs(pivots(rank)) > kDependent * scale) ++rank;
  return rank;
}

}  // namespace

StageKkt::StageKkt(StagewiseNlp& nlp) : nlp_(nlp), num_stages_(nlp.num_stages()) {
  stages_.resize(static_cast<std::size_t>(num_stages_));
  for (int k = 0; k < num_stages_; ++k) {
    Stage& s = stage(k);
    s.size = nlp.size(k);
    const int inputs = s.size.inputs, states = s.size.states, next = k + 1 < num_stages_ ? nlp.size(k + 1).states : 0;
    s.M.setZero(inputs + states, inputs + states);
    s.m.setZero(inputs + states);
    s.P.setZero(states, states);
    s.p.setZero(states);
    steps_.push_back(VectorXd::Zero(inputs + states));
    on_equalities_.push_back(VectorXd::Zero(s.size.equalities));
    on_next_.push_back(VectorXd::Zero(next));
    along_inequalities_.push_back(VectorXd::Zero(s.size.inequalities));
  }
}

StageKkt::Outcome StageKkt::factorise(Hessian hessian, double delta, const StageVectors& weights) {
  for (int k = num_stages_ - 1; k >= 0; --k) {
    if (!factorise_stage(k, hessian, delta, weights[static_cast<std::size_t>(k)])) {
      return stage(k).M.allFinite() ? Outcome::indefinite : Outcome::not_finite;
    }
  }
  return Outcome::solvable;
}

bool StageKkt::factorise_stage(int k, Hessian hessian, double delta, const VectorXd& weights) {
  Stage& s = stage(k);
  const bool is_last = k + 1 == num_stages_;
  nlp_.condense(k, is_last ? no_hessian_ : stage(k + 1).P, weights, s.M);
  if (hessian == Hessian::lagrangian) s.M += nlp_.lagrangian_hessian(k);
  s.M.diagonal().array() += delta;

  s.carried = is_last ? 0 : stage(k + 1).passed;
  const int own = s.size.equalities - s.determined();
  s.others.resize(s.num_others(), s.size.variables());
  s.others.topRows(own) = nlp_.equality_slopes(k).bottomRows(own);
  for (int i = 0; i < s.carried; ++i) {
    s.m.setZero();
    on_next_[static_cast<std::size_t>(k)] = stage(k + 1).E.row(i).transpose();
    unused_.setZero(s.size.inequalities);
    nlp_.add_pull_back(k, on_next_[static_cast<std::size_t>(k)], unused_, s.m);
    s.others.row(own + i) = s.m.transpose();
  }

  if (s.determined() > 0) {
    const auto slopes = nlp_.equality_slopes(k).topRows(s.determined());
    s.determining.compute(slopes.leftCols(s.determined()));
    s.K = slopes.rightCols(s.size.variables() - s.determined());
    work_ = s.determining.solve(s.K);
    s.K = -work_;
  }
  eliminate_determined(s);
  eliminate_others(s);

  const int first_state = s.rest(), rank = s.rank, states = s.size.states;
  // What is left: free inputs and states.
  auto free_free = s.N.block(rank, rank, s.free(), s.free());
  auto free_state = s.N.block(rank, first_state, s.free(), states);
  auto state_state = s.N.block(first_state, first_state, states, states);
  if (rank > 0) {
    const auto one_one = s.N.topLeftCorner(rank, rank);
    const auto state_one = s.N.block(first_state, 0, states, rank);
    s.S.resize(states, rank);
    s.S = state_one;
    state_state.noalias() += state_one * s.Y;
    s.S.noalias() += s.Y.transpose() * one_one;
    state_state.noalias() += s.Y.transpose() * s.S.transpose();
    free_state.noalias() += s.N.block(rank, 0, s.free(), rank) * s.Y;
  }
  s.P = 0.5 * (state_state + state_state.transpose());
  if (s.free() == 0) return s.P.allFinite();
  s.cholesky.compute(free_free);
  if (s.cholesky.info() != Eigen::Success || !s.cholesky.matrixLLT().diagonal().allFinite()) return false;
  s.G = free_state;
  s.cholesky.matrixL().solveInPlace(s.G);
  s.P.noalias() -= s.G.transpose() * s.G;
  return true;
}

void StageKkt::eliminate_determined(Stage& s) {
  const int d = s.determined(), r = s.size.variables() - d;
  s.N = s.M.bottomRightCorner(r, r);
  s.reduced = s.others.rightCols(r);
  if (d == 0) return;
  // N = M_rr + M_rd K + K' M_dr + K' M_dd K, with T = M_dd K + M_dr.
  s.T = s.M.topRightCorner(d, r);
  s.T.noalias() += 0.5 * s.M.topLeftCorner(d, d) * s.K;
  work_.resize(r, r);
  work_.noalias() = s.T.transpose() * s.K;
  s.N += work_;
  s.N += work_.transpose();
  s.T.noalias() += 0.5 * s.M.topLeftCorner(d, d) * s.K;
  s.reduced.noalias() += s.others.leftCols(d) * s.K;
}

void StageKkt::eliminate_others(Stage& s) {
  const int rows = s.num_others(), inputs = s.rest(), states = s.size.states;
  s.rank = s.passed = 0;
  if (rows == 0) return;
  if (inputs > 0) {
    const double scale = s.others.cwiseAbs().maxCoeff();
    s.range.compute(s.reduced.leftCols(inputs).transpose());
    s.rank = rank_of(s.range, scale);
    s.Q = s.range.householderQ() * MatrixXd::Identity(inputs, inputs);
    work_ = s.Q.transpose() * s.N.topRows(inputs);
    s.N.topRows(inputs) = work_;
    work_ = s.N.leftCols(inputs) * s.Q;
    s.N.leftCols(inputs) = work_;
  }
  const int rank = s.rank, left = rows - rank;
  // Rows in the order of the pivots: [R1' 0; R2' 0] y + X dx + c = 0.
  MatrixXd in_states = s.reduced.rightCols(states);
  if (inputs > 0) in_states = s.range.colsPermutation().transpose() * in_states;
  if (rank > 0) {
    s.Y = -in_states.topRows(rank);
    s.range.matrixQR().topLeftCorner(rank, rank).triangularView<Eigen::Upper>().transpose().solveInPlace(s.Y);
    in_states.bottomRows(left).noalias() +=
        s.range.matrixQR().block(0, rank, rank, left).transpose() * s.Y;
  }
  s.passed_rows.clear();
  if (left > 0 && states > 0) {  // those that depend on each other once
    const double scale = s.others.cwiseAbs().maxCoeff();
    const Eigen::ColPivHouseholderQR<MatrixXd> qr(in_states.bottomRows(left).transpose());
    s.passed = rank_of(qr, scale);
    s.E.resize(s.passed, states);
    for (int i = 0; i < s.passed; ++i) {
      const int row = static_cast<int>(qr.colsPermutation().indices()(i));
      s.passed_rows.push_back(rank + row);
      s.E.row(i) = in_states.row(rank + row);
    }
  }
}

void StageKkt::solve(const StageVectors& gradient, const StageVectors& equalities, const StageVectors& links) {
  for (int k = num_stages_ - 1; k >= 0; --k) {
    const auto i = static_cast<std::size_t>(k);
    backward(k, gradient[i], equalities[i], k + 1 < num_stages_ ? &links[i] : nullptr);
  }
  for (int k = 0; k < num_stages_; ++k) {
    forward(k, k + 1 < num_stages_ ? &links[static_cast<std::size_t>(k)] : nullptr);
  }
}

void StageKkt::backward(int k, const VectorXd& gradient, const VectorXd& equalities, const VectorXd* link) {
  Stage& s = stage(k);
  const int d = s.determined(), r = s.size.variables() - d, inputs = s.rest(), states = s.size.states;
  const int own = s.size.equalities - d, rank = s.rank;
  s.m = gradient;
  s.c.resize(s.num_others());
  s.c.head(own) = equalities.tail(own);
  if (link) {
    const Stage& next = stage(k + 1);
    VectorXd& on_next = on_next_[static_cast<std::size_t>(k)];
    on_next = next.p;
    on_next.noalias() += next.P * *link;
    unused_.setZero(s.size.inequalities);
    nlp_.add_pull_back(k, on_next, unused_, s.m);
    if (s.carried > 0) {
      s.c.tail(s.carried) = next.e;
      s.c.tail(s.carried).noalias() += next.E * *link;
    }
  }

  s.y = s.m.tail(r);  // gradient in (inputs that are not determined, states)
  if (d > 0) {
    s.k = s.determining.solve(equalities.head(d));
    s.k = -s.k;
    s.y.noalias() += s.K.transpose() * s.m.head(d);
    s.y.noalias() += s.T.transpose() * s.k;
    s.c.noalias() += s.others.leftCols(d) * s.k;
  }
  if (s.num_others() > 0 && inputs > 0) {
    s.y.head(inputs) = (s.Q.transpose() * s.y.head(inputs)).eval();
    s.c = (s.range.colsPermutation().transpose() * s.c).eval();
  }
  s.p = s.y.tail(states);
  if (rank > 0) {
    s.c_y = -s.c.head(rank);
    const auto R = s.range.matrixQR().topRows(rank);
    R.leftCols(rank).triangularView<Eigen::Upper>().transpose().solveInPlace(s.c_y);
    s.c.tail(s.c.size() - rank).noalias() += R.middleCols(rank, s.c.size() - rank).transpose() * s.c_y;
    s.p.noalias() += s.Y.transpose() * s.y.head(rank);
    s.p.noalias() += s.S * s.c_y;
    s.y.segment(rank, s.free()).noalias() += s.N.block(rank, 0, s.free(), rank) * s.c_y;
  }
  s.e.resize(s.passed);
  for (int i = 0; i < s.passed; ++i) s.e(i) = s.c(s.passed_rows[static_cast<std::size_t>(i)]);
  if (s.free() > 0) {
    auto free = s.y.segment(rank, s.free());
    s.cholesky.matrixL().solveInPlace(free);
    s.p.noalias() -= s.G.transpose() * free;
  }
}

void StageKkt::forward(int k, const VectorXd* link) {
  Stage& s = stage(k);
  const int d = s.determined(), inputs = s.rest(), states = s.size.states, rank = s.rank;
  VectorXd& step = steps_[static_cast<std::size_t>(k)];
  const auto dx = step.tail(states);
  auto rest = step.segment(d, inputs);
  if (s.free() > 0) {
    auto free = rest.tail(s.free());
    free = -s.y.segment(rank, s.free());
    free.noalias() -= s.G * dx;
    s.cholesky.matrixU().solveInPlace(free);
  }
  if (rank > 0) {
    rest.head(rank) = s.c_y;
    rest.head(rank).noalias() += s.Y * dx;
  }
  if (s.num_others() > 0 && inputs > 0) rest = (s.Q * rest).eval();
  if (d > 0) {
    step.head(d) = s.k;
    step.head(d).noalias() += s.K * step.tail(step.size() - d);
  }

  // Multipliers, from the gradient in the inputs: M step + m + equalities' on_equalities + carried' on_carried = 0.
  VectorXd& on_equalities = on_equalities_[static_cast<std::size_t>(k)];
  s.m.noalias() += s.M * step;
  const int rows = s.num_others(), own = s.size.equalities - d;
  s.on_others.setZero(rows);
  for (int i = 0; i < s.passed; ++i) s.on_others(s.passed_rows[static_cast<std::size_t>(i)]) = s.on_carried(i);
  if (rank > 0) {
    VectorXd& pull = s.y;
    pull = s.m.segment(d, inputs);
    if (d > 0) pull.noalias() += s.K.leftCols(inputs).transpose() * s.m.head(d);
    pull = (s.Q.transpose() * pull).eval();
    const auto R = s.range.matrixQR().topRows(rank);
    auto on_range = s.on_others.head(rank);
    on_range = -pull.head(rank);
    on_range.noalias() -= R.middleCols(rank, rows - rank) * s.on_others.tail(rows - rank);
    R.leftCols(rank).triangularView<Eigen::Upper>().solveInPlace(on_range);
  }
  if (rows > 0 && inputs > 0) s.on_others = (s.range.colsPermutation() * s.on_others).eval();
  on_equalities.tail(own) = s.on_others.head(own);
  if (d > 0) {
    s.k = -s.m.head(d);
    s.k.noalias() -= s.others.leftCols(d).transpose() * s.on_others;
    on_equalities.head(d) = s.determining.transpose().solve(s.k);
  }
  VectorXd& moved = on_next_[static_cast<std::size_t>(k)];
  nlp_.push_forward(k, step, moved, along_inequalities_[static_cast<std::size_t>(k)]);
  if (!link) return;

  Stage& next = stage(k + 1);
  next.on_carried = s.on_others.tail(s.carried);
  auto dx_next = steps_[static_cast<std::size_t>(k) + 1].tail(next.size.states);
  dx_next = moved + *link;
  moved = next.p;
  moved.noalias() += next.P * dx_next;
  if (s.carried > 0) moved.noalias() += next.E.transpose() * next.on_carried;
}

}  // namespace prowl

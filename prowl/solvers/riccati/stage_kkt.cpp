#include "prowl/solvers/riccati/stage_kkt.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numeric>

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

/// The first inputs are determined where they move at most so much more than what moves them. Accelerations do: up to
/// 1e4 on HyQ, ANYmal and Go2, 2e4 on Talos, by its light wrists. At landings the first inputs barely tell the
/// equalities apart: 1e5 to 1e9, with as many digits lost.
constexpr double kLargestGain = 1e5;

double largest_or_nan(const MatrixXd& matrix) {
  return matrix.size() > 0 ? matrix.cwiseAbs().maxCoeff<Eigen::PropagateNaN>() : 0.0;
}

bool has_finite_lower_triangle(const MatrixXd& square) {
  for (Index j = 0; j < square.cols(); ++j) {
    if (!square.col(j).tail(square.rows() - j).allFinite()) return false;
  }
  return true;
}

}  // namespace

StageKkt::StageKkt(LinearisedChain& chain, Start start) : chain_(chain), num_stages_(chain.num_stages()) {
  stages_.resize(static_cast<std::size_t>(num_stages_));
  for (int k = 0; k < num_stages_; ++k) {
    Stage& s = stage(k);
    s.size = chain.size(k);
    on_equalities_.push_back(VectorXd::Zero(s.size.equalities));
    if (k + 1 == num_stages_) s.size.equalities -= static_cast<int>(num_closing());
    if (k == 0 && start == Start::free)
      s.size = {s.size.variables(), 0, s.size.equalities, s.size.inequalities};  // no stage leads to these states
    const int variables = s.size.variables(), next = k + 1 < num_stages_ ? chain.size(k + 1).states : 0;
    for (int i = 0; i < variables; ++i) s.order.push_back(i);
    // Online nothing may be allocated where a stage first needs full pivoting.
    if (start == Start::given) {
      s.full_lu = Eigen::FullPivLU<MatrixXd>(s.size.equalities, s.size.inputs);
      work_.in_states.of_size(s.size.equalities, s.size.states);
      work_.M.of_size(variables, variables);
    }
    s.P.setZero(s.size.states, s.size.states);
    s.p.setZero(s.size.states);
    steps_.push_back(VectorXd::Zero(variables));
    on_next_.push_back(VectorXd::Zero(next));
    along_inequalities_.push_back(VectorXd::Zero(s.size.inequalities));
  }
  residual_next_ = on_next_;
  residual_inequalities_ = along_inequalities_;
}

void StageKkt::determine_inputs() {
  neglected_ = 0.0;
  num_pivoted_ = 0;
  for (int k = num_stages_ - 1; k >= 0; --k) {
    Stage& s = stage(k);
    const MatrixXd& equalities = gather_equalities(k);
    s.passed = 0;
    s.pivoted = !determine_first_inputs(s, equalities);
    s.has_finite_equalities = !s.pivoted || equalities.allFinite();
    if (!s.has_finite_equalities) return;
    if (!s.pivoted) continue;
    determine_any_inputs(s, equalities);
    ++num_pivoted_;
  }
}

StageKkt::Outcome StageKkt::factorise(Hessian hessian, double delta, const StageVectors& weights) {
  const Outcome outcome = factorise_first(num_stages_, hessian, delta, weights);
  if (outcome != Outcome::solvable || num_closing() == 0) return outcome;
  return factorise_closure() ? Outcome::solvable : Outcome::indefinite;
}

StageKkt::Outcome StageKkt::factorise_first(int stages, Hessian hessian, double delta, const StageVectors& weights) {
  num_negative_ = 0;
  hessian_ = hessian;
  delta_ = delta;
  weights_ = weights;
  for (int k = stages - 1; k >= 0; --k) {
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
  if (!s.has_finite_equalities) return Outcome::not_finite;
  const int variables = s.size.variables();
  MatrixXd& condensed = work_.condensed.of_size(variables, variables);
  if (hessian_ == Hessian::lagrangian) {
    const MatrixXd& lower = chain_.lagrangian_hessian(k);  // above the diagonal it is undefined
    for (int j = 0; j < variables; ++j) condensed.col(j).tail(variables - j) = lower.col(j).tail(variables - j);
  } else {
    condensed.setZero();
  }
  chain_.add_condensed(k, k + 1 < num_stages_ ? stage(k + 1).P : no_hessian_, weights_[k], condensed);
  condensed.diagonal().array() += delta_;
  MatrixXd* M = &condensed;
  if (s.pivoted) {
    M = &work_.M.of_size(variables, variables);
    put_in_order(s, condensed, *M);
  }
  eliminate(s, *M);
  if (minimise(s, M->bottomRightCorner(s.rest(), s.rest()))) return Outcome::solvable;
  return has_finite_lower_triangle(*M) ? Outcome::indefinite
                                       : Outcome::not_finite;  // what is not finite gets to L or P
}

/// Own equalities and those on the next stage's state.
const MatrixXd& StageKkt::gather_equalities(int k) {
  Stage& s = stage(k);
  s.carried = k + 1 < num_stages_ ? stage(k + 1).passed : 0;
  if (s.carried == 0 && s.size.equalities == chain_.size(k).equalities) return chain_.equality_slopes(k);
  MatrixXd& equalities = work_.equalities.of_size(s.num_equalities(), s.size.variables());
  equalities.topRows(s.size.equalities) = chain_.equality_slopes(k).topRows(s.size.equalities);
  for (int i = 0; i < s.carried; ++i) {
    VectorXd& on_next = on_next_[k];
    on_next = stage(k + 1).E.row(i).transpose();
    s.gradient.setZero(s.size.variables());
    chain_.add_pull_back(k, on_next, nothing_, s.gradient);
    equalities.row(s.size.equalities + i) = s.gradient.transpose();
  }
  return equalities;
}

template <class Pivots>
int StageKkt::count_independent(const MatrixXd& equalities, const Pivots& pivots) {
  const double scale = equalities.cwiseAbs().maxCoeff();
  int count = 0;
  while (count < pivots.size() && std::abs(pivots(count)) > kDependent * scale) ++count;
  const double next = count < pivots.size() ? std::abs(pivots(count)) : 0.0;
  if (!(next < kPivotRounding * scale)) neglected_ = std::max(neglected_, next);
  return count;
}

/// As many of the first inputs as there are equalities. False if they are not determined well.
bool StageKkt::determine_first_inputs(Stage& s, const MatrixXd& equalities) {
  const int rank = s.num_equalities(), rest = s.size.variables() - rank;
  if (rank > s.size.inputs) return false;
  MatrixXd &lu = work_.lu.of_size(rank, rank), &K = work_.K.of_size(rest, rank);
  lu = equalities.leftCols(rank);
  s.rows.clear();
  if (rank > 0) {
    if (!(kernels_.factorise_lu(lu, s.rows) > 0.0)) return false;
    for (int i = 0; i < rank; ++i) K.col(i) = -equalities.row(s.rows[i]).tail(rest).transpose();
    kernels_.divide_by_upper(K, lu.transpose(), MatrixKernels::Diagonal::ones);  // by L'
    kernels_.divide_by_lower(K, lu.transpose());                                 // by U'
    if (!lu.diagonal().allFinite() || !(largest_or_nan(K) <= kLargestGain)) return false;
  }
  s.rank = rank;
  s.lu = lu;
  s.K = K;
  std::iota(s.order.begin(), s.order.end(), 0);
  return true;
}

/// By full pivoting: any inputs, any rank.
void StageKkt::determine_any_inputs(Stage& s, const MatrixXd& equalities) {
  const int rows = s.num_equalities(), inputs = s.size.inputs, states = s.size.states;
  s.rank = 0;
  s.rows.resize(static_cast<std::size_t>(rows));
  std::iota(s.rows.begin(), s.rows.end(), 0);
  std::iota(s.order.begin(), s.order.end(), 0);
  MatrixXd& in_states = work_.in_states.of_size(rows, states);
  if (inputs > 0) {
    const auto& lu = s.full_lu.compute(equalities.leftCols(inputs));
    s.rank = count_independent(equalities, lu.matrixLU().diagonal());
    for (int i = 0; i < inputs; ++i) s.order[i] = lu.permutationQ().indices()(i);
    for (int i = 0; i < rows; ++i) s.rows[lu.permutationP().indices()(i)] = i;
    s.lu = lu.matrixLU().leftCols(s.rank);
  }
  for (int i = 0; i < rows; ++i) in_states.row(i) = equalities.row(s.rows[i]).tail(states);
  s.K.resize(s.rest(), s.rank);
  if (s.rank > 0) {
    const auto square = s.lu.topRows(s.rank);
    auto determining = in_states.topRows(s.rank);
    if (states > 0) square.triangularView<Eigen::UnitLower>().solveInPlace(determining);
    in_states.bottomRows(rows - s.rank).noalias() -= s.lu.bottomRows(rows - s.rank) * determining;
    s.K.topRows(s.free()) = -s.full_lu.matrixLU().block(0, s.rank, s.rank, s.free()).transpose();
    s.K.bottomRows(states) = -determining.transpose();
    kernels_.divide_by_lower(s.K, s.lu.transpose());  // by U'
  }
  pass_conditions(s, equalities, in_states);
}

/// M with permuted inputs, from and to lower triangles.
void StageKkt::put_in_order(const Stage& s, const MatrixXd& condensed, MatrixXd& M) {
  const int inputs = s.size.inputs, states = s.size.states;
  for (int j = 0; j < inputs; ++j) {
    const Index column = s.order[j];
    for (int i = 0; i < inputs; ++i) M(i, j) = condensed(std::max(s.order[i], column), std::min(s.order[i], column));
    M.col(j).tail(states) = condensed.col(column).tail(states);
  }
  M.bottomRightCorner(states, states) = condensed.bottomRightCorner(states, states);
}

/// M in the remaining variables, in place: N = M_rr + M_rd K' + K M_dr + K M_dd K'.
void StageKkt::eliminate(Stage& s, MatrixXd& M) {
  const int rank = s.rank, rest = s.rest();
  s.M_dd = M.topLeftCorner(rank, rank).selfadjointView<Eigen::Lower>();
  const auto M_rd = M.bottomLeftCorner(rest, rank);
  auto N = M.bottomRightCorner(rest, rest);
  s.T = M_rd;  // and half of K M_dd, so that both sides get all of it
  kernels_.add(s.T, s.K, s.M_dd, 0.5);
  kernels_.add_lower(N, s.T, s.K);
  kernels_.add_lower(N, s.K, s.T);
  s.T = 2.0 * s.T - M_rd;
}

/// Over the free inputs, which leaves the cost-to-go. False if there is no minimum, or no finite one.
bool StageKkt::minimise(Stage& s, const Eigen::Ref<const MatrixXd>& N) {
  const int free = s.free(), states = s.size.states;
  s.L = N.topLeftCorner(free, free);
  s.G = N.bottomLeftCorner(states, free);
  s.P = N.bottomRightCorner(states, states);
  s.signs.resize(0);
  if (!kernels_.factorise_cholesky(s.L) || !s.L.diagonal().allFinite())
    return num_closing() > 0 && has_finite_lower_triangle(N) && make_stationary(s, N);
  kernels_.divide_by_upper(s.G, s.L.transpose());
  kernels_.add_lower(s.P, s.G, s.G, -1.0);
  s.P.triangularView<Eigen::StrictlyUpper>() = s.P.transpose();
  return is_finite(s.P);
}

/// The same where there is no minimum: its stationary point. False if that is not unique.
bool StageKkt::make_stationary(Stage& s, const Eigen::Ref<const MatrixXd>& N) {
  constexpr double kSingular = 1e-12;  // of the largest eigenvalue
  const int free = s.free(), states = s.size.states;
  const Eigen::SelfAdjointEigenSolver<MatrixXd> shapes(N.topLeftCorner(free, free));  // of the lower triangle
  const VectorXd& values = shapes.eigenvalues();
  if (!(values.cwiseAbs().minCoeff() > kSingular * values.cwiseAbs().maxCoeff())) return false;
  s.signs = values.cwiseSign();
  num_negative_ += static_cast<int>((values.array() < 0.0).count());
  s.inverse_L = values.cwiseAbs().cwiseSqrt().cwiseInverse().asDiagonal() * shapes.eigenvectors().transpose();
  s.G = N.bottomLeftCorner(states, free) * s.inverse_L.transpose();
  s.P = N.bottomRightCorner(states, states).selfadjointView<Eigen::Lower>();
  s.P -= s.G * s.signs.asDiagonal() * s.G.transpose();
  return is_finite(s.P);
}

/// Independent conditions on the state: from equalities that determine no input.
void StageKkt::pass_conditions(Stage& s, const MatrixXd& equalities, const MatrixXd& in_states) {
  s.passed_rows.clear();
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

}  // namespace prowl

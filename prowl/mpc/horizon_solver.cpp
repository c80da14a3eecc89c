#include "prowl/mpc/horizon_solver.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kFirstRegularisation = 1e-4, kGrowth = 8.0, kDecrease = 0.25, kMost = 1e4;
/// Largest change of a state by one step, in units of the stages: beyond it the linearisation means nothing.
constexpr double kLargestStep = 10.0;
/// Steps that can act before the next plan, or the one after, replaces them.
constexpr int kNearSteps = 8;
/// Barrier parameters of steps of mean length: of bounds that start, and where a quadratic program whose first step
/// does not fit begins anew, with distances of at least kOpenDistance [units of the rows].
constexpr double kFreshBarrier = 1.0, kOpenBarrier = 1e-2, kOpenDistance = 0.05;
/// A quadratic program ends with a mean product of distances and multipliers of so many times the barrier parameter.
constexpr double kMostProducts = 30.0;

}  // namespace

HorizonSolver::HorizonSolver(HorizonProgram& program, double barrier, int iterations, int feedback_iterations)
    : program_(program),
      kkt_(program, StageKkt::Start::given),
      barrier_(barrier),
      iterations_(iterations),
      feedback_iterations_(feedback_iterations),
      near_(std::min(kNearSteps, program.num_stages())) {
  const StageSize& size = program.size(0);
  for (int k = 0; k < program.num_stages(); ++k) {
    rows_.emplace_back(size.inequalities);
    weights_.emplace_back(VectorXd::Zero(size.inequalities));
    pull_.emplace_back(VectorXd::Zero(size.inequalities));
    inequalities_.emplace_back(VectorXd::Zero(size.inequalities));
    gradient_.emplace_back(VectorXd::Zero(size.variables()));
    cost_gradient_.emplace_back(VectorXd::Zero(size.variables()));
    step_.emplace_back(VectorXd::Zero(size.variables()));
    equalities_.emplace_back(VectorXd::Zero(size.equalities));
    links_.emplace_back(VectorXd::Zero(k + 1 < program.num_stages() ? size.states : 0));
  }
  residuals_.assign(static_cast<std::size_t>(program.num_stages()), 0.0);
  states_.setZero(size.states);
  gain_.setZero(size.inputs, size.states);
}

void HorizonSolver::restart() {
  for (int k = 0; k < program_.num_stages(); ++k) {
    rows_[k].reset();
    StageMultipliers& on = program_.multipliers(k);
    for (VectorXd* multipliers : {&on.equalities, &on.inequalities, &on.next}) multipliers->setZero();
  }
}

bool HorizonSolver::prepare() {
  const int stages = program_.num_stages();
  mean_length_ = 0.0;
  for (int k = 0; k < stages; ++k) mean_length_ += program_.step(k).length / stages;
  violation_ = 0.0;
  try {
    for (int k = 0; k < stages; ++k) {
      program_.linearise(k);
      equalities_[k] = program_.equalities(k);
      links_[k] = program_.link(k);
      inequalities_[k] = program_.inequalities(k);
      step_[k].setZero();
      cost_gradient_[k] = program_.cost_gradient(k);
      violation_ = std::max(violation_, equalities_[k].lpNorm<Eigen::Infinity>());
      if (k + 1 < stages) violation_ = std::max(violation_, links_[k].lpNorm<Eigen::Infinity>());
      if (!program_.cost_gradient(k).allFinite() || !is_finite(program_.equality_slopes(k))) return false;
    }
  } catch (const NumericalError&) {
    return false;
  }
  if (!std::isfinite(violation_)) return false;
  kkt_.determine_inputs();
  set_weights();
  aim(barrier_);
  states_.setZero();
  if (!factorise() || !solve(stages, iterations_)) return false;
  set_weights();
  set_cost_gradient();
  aim(barrier_);
  return factorise();
}

/// A barrier parameter of a step of mean length for step k: the barrier is a running cost.
double HorizonSolver::scaled(double barrier, int k) const { return barrier * program_.step(k).length / mean_length_; }

double HorizonSolver::residual(int stages) const {
  return *std::max_element(residuals_.begin(), residuals_.begin() + stages);
}

void HorizonSolver::set_weights() {
  for (int k = 0; k < program_.num_stages(); ++k)
    rows_[k].linearise(inequalities_[k], scaled(kFreshBarrier, k), weights_[k]);
}

void HorizonSolver::aim(double barrier) {
  for (int k = 0; k < program_.num_stages(); ++k) rows_[k].aim(scaled(barrier, k), pull_[k]);
  set_gradient();
}

void HorizonSolver::correct(double barrier) {
  for (int k = 0; k < program_.num_stages(); ++k) rows_[k].correct(scaled(barrier, k), pull_[k]);
  set_gradient();
}

/// Of the cost, at the variables plus the step so far.
void HorizonSolver::set_cost_gradient() {
  for (int k = 0; k < program_.num_stages(); ++k) {
    cost_gradient_[k] = program_.cost_gradient(k);
    cost_gradient_[k].noalias() += program_.lagrangian_hessian(k).selfadjointView<Eigen::Lower>() * step_[k];
  }
}

void HorizonSolver::set_gradient() {
  for (int k = 0; k < program_.num_stages(); ++k) {
    gradient_[k] = cost_gradient_[k];
    program_.add_pull_back(k, nothing_, pull_[k], gradient_[k]);
  }
}

bool HorizonSolver::factorise() {
  double delta = regularisation_ > kFirstRegularisation ? kDecrease * regularisation_ : 0.0;
  while (true) {
    const StageKkt::Outcome outcome = kkt_.factorise(StageKkt::Hessian::lagrangian, delta, weights_);
    if (outcome == StageKkt::Outcome::solvable) break;
    if (outcome == StageKkt::Outcome::not_finite || delta > kMost) return false;
    delta = delta == 0.0 ? kFirstRegularisation : kGrowth * delta;
  }
  regularisation_ = delta;
  return true;
}

bool HorizonSolver::find_direction() {
  kkt_.set_start(states_);
  kkt_.solve(gradient_, equalities_, links_, std::numeric_limits<double>::infinity());
  for (int k = 0; k < program_.num_stages(); ++k) {
    if (!kkt_.steps()[k].allFinite() || !kkt_.on_equalities()[k].allFinite()) return false;
    rows_[k].find_steps(kkt_.along_inequalities()[k]);
  }
  return true;
}

double HorizonSolver::longest() const {
  double share = 1.0;
  for (int k = 0; k < program_.num_stages(); ++k) share = std::min(share, rows_[k].longest());
  return share;
}

void HorizonSolver::take(double share) {
  for (int k = 0; k < program_.num_stages(); ++k) {
    residuals_[k] = rows_[k].step(share);
    step_[k] += share * kkt_.steps()[k];
    inequalities_[k] += share * kkt_.along_inequalities()[k];
    equalities_[k] *= 1.0 - share;
    links_[k] *= 1.0 - share;
  }
  states_ *= 1.0 - share;
}

double HorizonSolver::products(double share) const {
  double sum = 0.0;
  for (int k = 0; k < program_.num_stages(); ++k) sum += rows_[k].products(share);
  return sum;
}

/// Until the rows of the first `judged` steps fit. The first step is taken as a whole, as it removes the violations of
/// dynamics and start.
bool HorizonSolver::solve(int judged, int most_iterations) {
  if (!find_direction()) return false;
  take(1.0);
  done_ = 1;
  return residual(judged) <= kTolerance || solve_anew(judged, most_iterations);
}

/// By Mehrotra's predictor and corrector, from distances that leave room.
bool HorizonSolver::solve_anew(int judged, int most_iterations) {
  int count = 0;
  for (int k = 0; k < program_.num_stages(); ++k) {
    rows_[k].open(inequalities_[k], scaled(kOpenBarrier, k), kOpenDistance);
    count += rows_[k].num_products();
  }
  const auto mean_product = [&](double share) { return products(share) / std::max(count, 1); };
  for (bool is_solved = false; !is_solved && done_ < most_iterations; ++done_) {
    set_weights();
    set_cost_gradient();
    aim(0.0);
    if (!factorise() || !find_direction()) return false;
    const double before = mean_product(0.0), ahead = mean_product(longest()) / before;
    correct(std::max(barrier_, before * ahead * ahead * ahead));
    if (!find_direction()) return false;
    take(longest());
    is_solved = residual(judged) <= kTolerance && mean_product(0.0) <= kMostProducts * barrier_;
  }
  return true;
}

bool HorizonSolver::step(const VectorXd& q, const VectorXd& v) {
  const int stages = program_.num_stages();
  program_.to_states(0, q, v, states_);
  states_ -= program_.variables(0).tail(states_.size());
  start_ = states_;
  if (!solve(near_, feedback_iterations_) || residual() > kUnsolved) return false;
  double largest = 0.0;
  for (int k = 0; k < stages; ++k)
    largest = std::max(largest, step_[k].tail(program_.size(k).states).lpNorm<Eigen::Infinity>());
  share_ = std::min(1.0, kLargestStep / largest);
  for (int k = 0; k < stages; ++k) {
    VectorXd& ux = program_.variables(k);
    ux += share_ * step_[k];
    StageMultipliers& on = program_.multipliers(k);
    on.equalities += share_ * (kkt_.on_equalities()[k] - on.equalities);
    if (k + 1 < stages) on.next += share_ * (kkt_.on_next()[k] - on.next);
    rows_[k].multipliers(on.inequalities);
  }
  program_.variables(0).tail(start_.size()) += (1.0 - share_) * start_;  // the start is where it is
  return true;
}

void HorizonSolver::torque_gain(int k, Eigen::Ref<Eigen::MatrixXd> gain) {
  const Eigen::Index states = program_.size(k).states;
  const int nv = program_.robot().nv(), nu = program_.robot().nu();
  kkt_.input_gain(k, gain_);
  gain = program_.unit().segment(nv, nu).asDiagonal() * gain_.middleRows(nv, nu) *
         program_.unit().tail(states).cwiseInverse().asDiagonal();
}

}  // namespace prowl

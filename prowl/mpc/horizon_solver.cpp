#include "prowl/mpc/horizon_solver.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;

constexpr double kFirstRegularisation = 1e-4, kGrowth = 8.0, kDecrease = 0.25, kMost = 1e4;
/// Largest change of a state by one step, in units of the stages: beyond it the linearisation means nothing.
constexpr double kLargestStep = 10.0;
/// Steps that feedback iterates: 0.05 to 0.1 s of a quadruped, of which 10 to 20 ms act. With 4, 2 of 24 walks of Go2
/// with kicks of 0.7 m/s fail that succeed with 6. With 8, feedback takes a fifth longer.
constexpr int kNearSteps = 6;
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
    along_.emplace_back(VectorXd::Zero(size.inequalities));
    gradient_.emplace_back(VectorXd::Zero(size.variables()));
    step_.emplace_back(VectorXd::Zero(size.variables()));
    equalities_.emplace_back(VectorXd::Zero(size.equalities));
    links_.emplace_back(VectorXd::Zero(k + 1 < program.num_stages() ? size.states : 0));
  }
  residuals_.assign(static_cast<std::size_t>(program.num_stages()), 0.0);
  values_ = change_ = VectorXd::Zero(size.inequalities);
  states_.setZero(size.states);
  after_near_ = states_;
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
      step_[k].setZero();
      along_[k].setZero();
      violation_ = std::max(violation_, equalities_[k].lpNorm<Eigen::Infinity>());
      if (k + 1 < stages) violation_ = std::max(violation_, links_[k].lpNorm<Eigen::Infinity>());
      if (!program_.cost_gradient(k).allFinite() || !is_finite(program_.equality_slopes(k))) return false;
    }
  } catch (const NumericalError&) {
    return false;
  }
  if (!std::isfinite(violation_)) return false;
  regularisation_ = regularisation_ > kFirstRegularisation ? kDecrease * regularisation_ : 0.0;
  kkt_.determine_inputs();
  states_.setZero();
  kkt_.set_states(0, states_);
  if (!set_up(stages, barrier_) || !solve(stages, iterations_)) return false;
  return set_up(stages, barrier_);
}

/// A barrier parameter of a step of mean length for step k: the barrier is a running cost.
double HorizonSolver::scaled(double barrier, int k) const { return barrier * program_.step(k).length / mean_length_; }

/// Of the rows of step k, after the step so far.
const VectorXd& HorizonSolver::values(int k) {
  values_ = program_.inequalities(k) + along_[k];
  return values_;
}

double HorizonSolver::residual(int stages) const {
  return *std::max_element(residuals_.begin(), residuals_.begin() + stages);
}

/// Newton's equations of the first stages, from where their rows are.
bool HorizonSolver::set_up(int stages, double barrier) {
  for (int k = 0; k < stages; ++k) rows_[k].linearise(values(k), scaled(kFreshBarrier, k), weights_[k]);
  if (!factorise(stages)) return false;
  for (int k = 0; k < stages; ++k) rows_[k].aim(scaled(barrier, k), pull_[k]);
  sweep_back(stages);
  return true;
}

/// For the whole step from the variables: rows pull as they do after the part of it that was taken.
void HorizonSolver::sweep_back(int stages) {
  for (int k = 0; k < stages; ++k) {
    pull_[k] -= weights_[k].cwiseProduct(along_[k]);
    gradient_[k] = program_.cost_gradient(k);
    program_.add_pull_back(k, nothing_, pull_[k], gradient_[k]);
  }
  kkt_.sweep_back(stages, gradient_, equalities_, links_);
}

/// What keeps the whole step near the variables must not weaken within a quadratic program.
bool HorizonSolver::factorise(int stages) {
  while (true) {
    const StageKkt::Outcome outcome =
        kkt_.factorise_first(stages, StageKkt::Hessian::lagrangian, regularisation_, weights_);
    if (outcome == StageKkt::Outcome::solvable) return true;
    if (outcome == StageKkt::Outcome::not_finite || regularisation_ > kMost) return false;
    regularisation_ = regularisation_ == 0.0 ? kFirstRegularisation : kGrowth * regularisation_;
  }
}

bool HorizonSolver::find_direction(int begin, int end) {
  kkt_.sweep_ahead(begin, end, links_);
  for (int k = begin; k < end; ++k) {
    if (!kkt_.steps()[k].allFinite() || !kkt_.on_equalities()[k].allFinite()) return false;
    change_ = kkt_.along_inequalities()[k] - along_[k];
    rows_[k].find_steps(change_);
  }
  return true;
}

double HorizonSolver::longest(int stages) const {
  double share = 1.0;
  for (int k = 0; k < stages; ++k) share = std::min(share, rows_[k].longest());
  return share;
}

void HorizonSolver::take(int begin, int end, double share) {
  for (int k = begin; k < end; ++k) {
    residuals_[k] = rows_[k].step(share);
    step_[k] += share * (kkt_.steps()[k] - step_[k]);
    along_[k] += share * (kkt_.along_inequalities()[k] - along_[k]);
  }
}

double HorizonSolver::products(int stages, double share) const {
  double sum = 0.0;
  for (int k = 0; k < stages; ++k) sum += rows_[k].products(share);
  return sum;
}

/// Until the rows of the first stages fit. The first step is taken as a whole, as it removes the violations of dynamics
/// and start.
bool HorizonSolver::solve(int stages, int most_iterations) {
  if (!find_direction(0, stages)) return false;
  take(0, stages, 1.0);
  done_ = 1;
  return residual(stages) <= kTolerance || most_iterations == 1 || solve_anew(stages, most_iterations);
}

/// By Mehrotra's predictor and corrector, from distances that leave room.
bool HorizonSolver::solve_anew(int stages, int most_iterations) {
  int count = 0;
  for (int k = 0; k < stages; ++k) {
    rows_[k].open(values(k), scaled(kOpenBarrier, k), kOpenDistance);
    count += rows_[k].num_products();
  }
  // Of steps of any length: near ones are short, which aims lower for them. With equal aims, feedback of Go2 fails
  // three times as often with kicks of 1.2 m/s.
  const auto mean_product = [&](double share) { return products(stages, share) / std::max(count, 1); };
  for (bool is_solved = false; !is_solved && done_ < most_iterations; ++done_) {
    if (!set_up(stages, 0.0) || !find_direction(0, stages)) return false;
    const double before = mean_product(0.0), ahead = mean_product(longest(stages)) / before;
    const double barrier = std::max(barrier_, before * ahead * ahead * ahead);
    for (int k = 0; k < stages; ++k) rows_[k].correct(scaled(barrier, k), pull_[k]);
    sweep_back(stages);
    if (!find_direction(0, stages)) return false;
    take(0, stages, longest(stages));
    is_solved = residual(stages) <= kTolerance && mean_product(0.0) <= kMostProducts * barrier_;
  }
  return true;
}

/// Moves the later steps by one step of Newton's, from where the share of the near ones that was taken leads.
bool HorizonSolver::follow_near() {
  const int stages = program_.num_stages();
  if (near_ == stages) return true;
  program_.push_forward(near_ - 1, step_[near_ - 1], after_near_, change_);
  after_near_ += links_[near_ - 1];
  kkt_.set_states(near_, after_near_);
  if (!find_direction(near_, stages)) return false;
  take(near_, stages, 1.0);
  return true;
}

bool HorizonSolver::step(const VectorXd& q, const VectorXd& v) {
  const int stages = program_.num_stages();
  program_.to_states(0, q, v, states_);
  states_ -= program_.variables(0).tail(states_.size());
  kkt_.set_states(0, states_);
  if (!solve(near_, feedback_iterations_) || residual(near_) > kUnsolved || !follow_near()) return false;
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
  program_.variables(0).tail(states_.size()) += (1.0 - share_) * states_;  // the start is where it is
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

// Step length of InteriorPoint along a direction, and restoration if no length is acceptable.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/solvers/riccati/interior_point.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

// Named as in Wächter and Biegler 2006.
constexpr double kTauMin = 0.99, kKappaSoc = 0.99, kKappaSigma = 1e10, kGammaAlpha = 0.05;
constexpr double kGammaTheta = 1e-5, kGammaPhi = 1e-8, kDelta = 1.0, kSTheta = 1.1, kSPhi = 2.3, kEtaPhi = 1e-8;
constexpr int kMostCorrections = 4;
constexpr double kShortestStep = 1e-12;  ///< fraction of a direction; smaller ones are rounding
constexpr int kMostRestorations = 100;
/// With start multipliers the first Newton steps go as far as the bounds allow, without the filter;
/// if they leave the constraints they are undone. Such a start violates one condition (the moved
/// goal); the step spreads its curvature over all stages, so the sum of violations first rises,
/// then falls by orders of magnitude. Halving would stall (goal moved by 2 cm, worst of 50): HyQ
/// balance 13 iterations, with one whole step 3; HyQ step 72, with one 16, with two 12, with four
/// 13.
constexpr int kWholeSteps = 2;
/// Allowed violation after them: kAway max(violation of the start, kSmallViolation).
constexpr double kAway = 10.0, kSmallViolation = 1e-2;

}  // namespace

bool InteriorPoint::try_step(double alpha, const StageVectors& steps, const VectorXd& ds) {
  for (std::size_t i = 0; i < ux_.size(); ++i) trial_ux_[i] = ux_[i] + alpha * steps[i];
  if (!slacks_.move(s_, alpha, ds) || !evaluate(trial_ux_, trial_)) return false;
  slacks_.reset(s_, trial_.inequalities, std::max(kTauMin, 1.0 - mu_));
  return true;
}

bool InteriorPoint::is_acceptable(double alpha, double theta, double phi, bool& is_phi_step) const {
  if (!std::isfinite(theta) || !std::isfinite(phi) || !filter_.accepts(theta, phi)) return false;
  // Near convergence rounding of phi must not reject a step.
  const double rounding = 10.0 * std::numeric_limits<double>::epsilon() * std::abs(phi_);
  is_phi_step = slope_ < 0.0 && alpha * std::pow(-slope_, kSPhi) > kDelta * std::pow(theta_, kSTheta);
  if (theta_ <= least_theta_ && is_phi_step) return phi - phi_ <= kEtaPhi * alpha * slope_ + rounding;
  is_phi_step = false;
  return theta <= (1.0 - kGammaTheta) * theta_ || phi - phi_ <= -kGammaPhi * theta_ + rounding;
}

bool InteriorPoint::correct_second_order(double alpha, double theta) {
  StageVectors links = values_.links, equalities = values_.equalities;
  VectorXd residual = values_.inequalities - s_;
  const VectorXd ds = ds_, step_lambda = step_lambda_;
  double last_theta = theta;
  const double tau = std::max(kTauMin, 1.0 - mu_);
  for (int i = 0; i < kMostCorrections; ++i) {
    for (std::size_t k = 0; k < links.size(); ++k) {
      links[k] = alpha * links[k] + trial_.links[k];
      equalities[k] = alpha * equalities[k] + trial_.equalities[k];
    }
    residual = alpha * residual + trial_.inequalities - slacks_.s;
    right_links_ = links;
    right_equalities_ = equalities;
    slacks_.s = s_;
    solve_direction(cost_scale_, residual);
    alpha = slacks_.longest_primal(tau, ds_);
    bool is_phi_step = false;
    if (!try_step(alpha, kkt_.steps(), ds_)) break;
    const double now = violation(trial_, slacks_.s);
    if (is_acceptable(alpha, now, barrier_function(trial_, slacks_), is_phi_step)) {
      if (!is_phi_step) filter_.add((1.0 - kGammaTheta) * theta_, phi_ - kGammaPhi * theta_);
      ds_ = ds;  // multipliers keep the step of the direction
      step_lambda_ = step_lambda;
      return true;
    }
    if (now > kKappaSoc * last_theta) break;
    last_theta = now;
  }
  slacks_.s = s_;
  ds_ = ds;
  step_lambda_ = step_lambda;
  return false;
}

void InteriorPoint::keep_point() {
  whole_steps_from_ = {ux_, slacks_, lambda_, on_, mu_, violation(values_, slacks_.s)};
}

/// Called once per iteration. After the whole steps it continues from their end, or from their
/// start if the end violates the constraints too much.
void InteriorPoint::end_whole_steps() {
  if (!whole_steps_from_ || iterations_ < kWholeSteps) return;
  if (!(violation(values_, slacks_.s) <= kAway * std::max(whole_steps_from_->theta, kSmallViolation))) {
    ux_ = whole_steps_from_->ux;
    slacks_ = whole_steps_from_->slacks;
    lambda_ = whole_steps_from_->lambda;
    on_ = whole_steps_from_->on;
    mu_ = whole_steps_from_->mu;
    if (!evaluate(ux_, values_)) throw NumericalError(failure_);  // was evaluated before
    linearise();
  }
  whole_steps_from_.reset();
}

bool InteriorPoint::search_line() {
  s_ = slacks_.s;
  theta_ = violation(values_, s_);
  phi_ = barrier_function(values_, slacks_);
  const double tau = std::max(kTauMin, 1.0 - mu_);
  const double longest_dual = slacks_.longest_dual(tau);
  longest_ = slacks_.longest_primal(tau, ds_);
  double least = kGammaTheta;
  if (slope_ < 0.0) {
    least = std::min(least, kGammaPhi * theta_ / -slope_);
    if (theta_ <= least_theta_) least = std::min(least, kDelta * std::pow(theta_, kSTheta) / std::pow(-slope_, kSPhi));
  }
  least = std::max(kGammaAlpha * least, kShortestStep);
  step_on_equalities_ = kkt_.on_equalities();
  step_on_next_ = kkt_.on_next();
  const bool takes_it_whole = whole_steps_from_.has_value();
  for (double alpha = longest_; alpha > least; alpha *= 0.5) {
    const bool is_good = try_step(alpha, step_, ds_);
    if (is_good && takes_it_whole) {
      accept(alpha, longest_dual);
      return true;
    }
    const double theta = is_good ? violation(trial_, slacks_.s) : 0.0;
    bool is_phi_step = false;
    if (is_good && is_acceptable(alpha, theta, barrier_function(trial_, slacks_), is_phi_step)) {
      if (!is_phi_step) filter_.add((1.0 - kGammaTheta) * theta_, phi_ - kGammaPhi * theta_);
      accept(alpha, longest_dual);
      return true;
    }
    if (is_good && alpha == longest_ && theta >= theta_ && correct_second_order(alpha, theta)) {
      accept(alpha, longest_dual);
      return true;
    }
  }
  slacks_.s = s_;
  return false;
}

void InteriorPoint::accept(double alpha_primal, double alpha_dual) {
  ux_.swap(trial_ux_);
  std::swap(values_, trial_);
  lambda_ += alpha_primal * (step_lambda_ - lambda_);
  for (std::size_t i = 0; i < on_.size(); ++i) {
    on_[i].next += alpha_primal * (step_on_next_[i] - on_[i].next);
    on_[i].equalities += alpha_primal * (step_on_equalities_[i] - on_[i].equalities);
  }
  slacks_.move_dual(alpha_dual, mu_, kKappaSigma);
}

/// Short steps towards the constraints, ignoring the cost, until the filter accepts the point;
/// otherwise returns the failure.
std::optional<InteriorPoint::Ending> InteriorPoint::restore_feasibility(const Watch& watch) {
  using enum SolveStatus;
  filter_.add((1.0 - kGammaTheta) * theta_, phi_ - kGammaPhi * theta_);
  const double theta_before = theta_;
  for (int i = 0; i < kMostRestorations; ++i) {
    if (i > 0) {
      if (auto ending = watch(++iterations_, figures_)) return ending;
    }
    slacks_.center(mu_);
    set_weights();
    if (factorise(StageKkt::Hessian::identity, std::sqrt(mu_)) != StageKkt::Outcome::solvable) {
      return Ending{solver_failed, fmt::format("restoration of feasibility: its equations are singular at {}",
                                               nlp_.describe_stage(kkt_.last_stage()))};
    }
    set_right_sides(values_, slacks_.s);
    solve_direction(0.0, residual_);
    if (!ds_.allFinite()) return Ending{solver_failed, "restoration of feasibility: the step is not finite"};
    s_ = slacks_.s;
    const double theta = violation(values_, s_);
    bool moved = false, evaluated = false;
    failure_.clear();
    for (double alpha = slacks_.longest_primal(kTauMin, ds_); !moved && alpha > kShortestStep; alpha *= 0.5) {
      if (!try_step(alpha, kkt_.steps(), ds_)) continue;
      evaluated = true;
      moved = violation(trial_, slacks_.s) <= (1.0 - 1e-4 * alpha) * theta;
    }
    if (!moved) {
      slacks_.s = s_;
      if (!evaluated && !failure_.empty()) return Ending{evaluation_failed, failure_};
      if (figures_.violation <= options_.tolerance) {
        return Ending{solver_failed, "no step along the search direction improves the iterate"};
      }
      return Ending{infeasible, "converged to a local minimum of the constraint violation"};
    }
    ux_.swap(trial_ux_);
    std::swap(values_, trial_);
    linearise_to_first_order();
    largest_dual_violation_ = std::numeric_limits<double>::infinity();  // not evaluated here
    update_figures();
    const double now = violation(values_, slacks_.s);
    if (now <= 0.9 * theta_before && filter_.accepts(now, barrier_function(values_, slacks_))) {
      slacks_.center(mu_);
      slacks_.pull(mu_, lambda_);
      estimate_multipliers();
      linearise();
      return std::nullopt;
    }
  }
  return Ending{solver_failed, fmt::format("restoration of feasibility: not finished in {} steps", kMostRestorations)};
}

}  // namespace prowl

#include "prowl/solvers/interior_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/solvers/stopwatch.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Of Wächter and Biegler 2006, with the names they have there.
constexpr double kKappaEpsilon = 10.0, kKappaMu = 0.2, kThetaMu = 1.5, kTauMin = 0.99;
constexpr double kGammaTheta = 1e-5, kGammaPhi = 1e-8, kDelta = 1.0, kSTheta = 1.1, kSPhi = 2.3, kEtaPhi = 1e-8;
constexpr double kGammaAlpha = 0.05, kKappaSoc = 0.99, kKappaSigma = 1e10, kSMax = 100.0;
constexpr int kMostCorrections = 4;
constexpr double kShortestStep = 1e-12;  ///< part of a direction; below it is rounding
constexpr double kLargestRegularisation = 1e20, kLeastRegularisation = 1e-20;

constexpr double kFirstRegularisation = 1e-2, kGrowth = 8.0, kDecrease = 1.0 / 3.0;
constexpr double kLargestMultiplier = 1e3;  ///< of an estimate that is of use
constexpr double kNearlyFeasible = 1e-2, kHugeMultiplier = 1e5;
constexpr double kLargestCostSlope = 100.0;
constexpr int kMostRestorations = 100;

/// First mu times the number of stages: the cost is an integral, the barrier a sum over stages, and for both to weigh the
/// same on each mesh mu has to fall as a step does (HyQ rear from the task alone on 350 intervals: with mu = 1e-3
/// 59 iterations, with this 22; on 23 intervals 16 and 16).
/// Near a solution whose multipliers are known slacks are placed by them, and mu can be near its end: HyQ balance with the goal
/// moved by 2 cm takes 7 iterations with 3e-4 and 4 with 3e-5 (medians).
constexpr double kFirstBarrier = 3e-2, kNearBarrier = 3e-4, kKnownBarrier = 3e-5;
constexpr double kFirstPush = 1e-2, kNearPush = 1e-4;  ///< of slacks off their bounds
/// Where no part of a step is an improvement, shorter steps by more regularisation, so many times.
constexpr double kFailureGrowth = 100.0;
constexpr int kMostFailures = 4;

std::vector<Index> first_rows(const StagewiseNlp& nlp) {
  std::vector<Index> rows = {0};
  for (int k = 0; k < nlp.num_stages(); ++k) rows.push_back(rows.back() + nlp.size(k).inequalities);
  return rows;
}

template <class Bound>
VectorXd stacked(const StagewiseNlp& nlp, Bound bound) {
  const std::vector<Index> rows = first_rows(nlp);
  VectorXd all(rows.back());
  for (int k = 0; k < nlp.num_stages(); ++k) {
    all.segment(rows[static_cast<std::size_t>(k)], nlp.size(k).inequalities) = bound(k);
  }
  return all;
}

double largest(const StageVectors& vectors) {
  double result = 0.0;
  for (const VectorXd& v : vectors) {
    if (v.size() > 0) result = std::max(result, v.cwiseAbs().maxCoeff());
  }
  return result;
}

double sum_of_sizes(const StageVectors& vectors) {
  double result = 0.0;
  for (const VectorXd& v : vectors) result += v.lpNorm<1>();
  return result;
}

}  // namespace

InteriorPoint::InteriorPoint(StagewiseNlp& nlp, const SolverOptions& options)
    : nlp_(nlp),
      options_(options),
      num_stages_(nlp.num_stages()),
      rows_(first_rows(nlp)),
      kkt_(nlp),
      slacks_(stacked(nlp, [&](int k) { return nlp.lower(k); }), stacked(nlp, [&](int k) { return nlp.upper(k); })) {
  for (int k = 0; k < num_stages_; ++k) {
    const StageSize& size = nlp.size(k);
    const Index next = k + 1 < num_stages_ ? nlp.size(k + 1).states : 0;
    on_.push_back({VectorXd::Zero(next), VectorXd::Zero(size.equalities), VectorXd::Zero(size.inequalities)});
    weights_.push_back(VectorXd::Zero(size.inequalities));
    gradient_.push_back(VectorXd::Zero(size.variables()));
    right_equalities_.push_back(VectorXd::Zero(size.equalities));
    right_links_.push_back(VectorXd::Zero(next));
  }
  dual_violation_ = step_ = trial_ux_ = gradient_;
  step_on_equalities_ = right_equalities_;
  step_on_next_ = no_next_ = right_links_;
  for (Values* values : {&values_, &trial_}) {
    values->links = right_links_;
    values->equalities = right_equalities_;
    values->inequalities.setZero(rows_.back());
  }
  for (VectorXd* v : {&s_, &ds_, &lambda_, &beta_, &sigma_, &residual_, &step_lambda_}) v->setZero(rows_.back());
}

bool InteriorPoint::evaluate(const StageVectors& ux, Values& values) {
  const Stopwatch stopwatch(times_.values);
  values.cost = 0.0;
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    try {
      const StageValues& stage = nlp_.values(k, ux[i]);
      values.cost += stage.cost;
      values.equalities[i] = stage.equalities;
      segment(values.inequalities, k) = stage.inequalities;
      if (k + 1 < num_stages_) values.links[i] = stage.next - ux[i + 1].tail(stage.next.size());
      if (std::isfinite(stage.cost) && stage.equalities.allFinite() && stage.inequalities.allFinite() &&
          stage.next.allFinite()) {
        continue;
      }
      failure_ = fmt::format("a function is not finite at {}", nlp_.describe_stage(k));
    } catch (const NumericalError& error) {
      failure_ = error.what();
    }
    return false;
  }
  return true;
}

void InteriorPoint::linearise() {
  const Stopwatch stopwatch(times_.derivatives);
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    on_[i].inequalities = segment(lambda_, k);
    nlp_.linearise(k, ux_[i], cost_scale_, on_[i]);
  }
}

StageKkt::Outcome InteriorPoint::factorise(StageKkt::Hessian hessian, double delta) {
  const Stopwatch stopwatch(times_.linear_algebra);
  return kkt_.factorise(hessian, delta, weights_);
}

double InteriorPoint::violation(const Values& values, const VectorXd& s) const {
  return sum_of_sizes(values.links) + sum_of_sizes(values.equalities) + (values.inequalities - s).lpNorm<1>();
}

double InteriorPoint::largest_violation(const Values& values, const VectorXd& s) const {
  const double inequalities = s.size() > 0 ? (values.inequalities - s).cwiseAbs().maxCoeff() : 0.0;
  return std::max({largest(values.links), largest(values.equalities), inequalities});
}

double InteriorPoint::barrier_function(const Values& values, const Slacks& slacks) const {
  return cost_scale_ * values.cost + mu_ * slacks.log_barrier();
}

void InteriorPoint::update_dual_violation() {
  largest_dual_violation_ = slacks_.largest_dual_violation(lambda_);
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    VectorXd& violation = dual_violation_[i];
    violation = cost_scale_ * nlp_.cost_gradient(k);
    violation.noalias() += nlp_.equality_slopes(k).transpose() * on_[i].equalities;
    on_[i].inequalities = segment(lambda_, k);
    nlp_.add_pull_back(k, on_[i].next, on_[i].inequalities, violation);
    if (k > 0) violation.tail(nlp_.size(k).states) -= on_[i - 1].next;
    if (!violation.allFinite()) throw NumericalError("derivatives are not finite at " + nlp_.describe_stage(k));
    if (violation.size() > 0) largest_dual_violation_ = std::max(largest_dual_violation_, violation.cwiseAbs().maxCoeff());
  }
}

double InteriorPoint::error(double mu) const {
  const double of_bounds = slacks_.sum_of_multipliers();
  double of_all = of_bounds + lambda_.lpNorm<1>();
  double count = slacks_.num_bounds() + static_cast<double>(lambda_.size());
  for (const StageMultipliers& on : on_) {
    of_all += on.next.lpNorm<1>() + on.equalities.lpNorm<1>();
    count += static_cast<double>(on.next.size() + on.equalities.size());
  }
  const double dual_scale = std::max(kSMax, of_all / std::max(1.0, count)) / kSMax;
  const double bound_scale = std::max(kSMax, of_bounds / std::max(1, slacks_.num_bounds())) / kSMax;
  return std::max({largest_dual_violation_ / dual_scale, largest_violation(values_, slacks_.s),
                   slacks_.largest_complementarity(mu) / bound_scale});
}

void InteriorPoint::update_figures() {
  figures_.cost = values_.cost;
  figures_.violation = largest_violation(values_, slacks_.s);
  figures_.dual_violation = largest_dual_violation_ / cost_scale_;
}

bool InteriorPoint::update_barrier() {
  const double least = options_.tolerance / (kKappaEpsilon + 1.0);
  if (mu_ <= least || error(mu_) > kKappaEpsilon * mu_) return false;
  mu_ = std::max(least, std::min(kKappaMu * mu_, std::pow(mu_, kThetaMu)));
  return true;
}

void InteriorPoint::scale_cost() {
  cost_scale_ = 1.0;
  linearise();
  double slope = 0.0;
  for (int k = 0; k < num_stages_; ++k) {
    if (nlp_.cost_gradient(k).size() > 0) slope = std::max(slope, nlp_.cost_gradient(k).cwiseAbs().maxCoeff());
  }
  if (slope > kLargestCostSlope) cost_scale_ = kLargestCostSlope / slope;
}

bool InteriorPoint::has_start_multipliers() const {
  const std::vector<StageMultipliers>& start = options_.start_multipliers;
  bool fits = options_.start_is_near && start.size() == on_.size();
  for (std::size_t i = 0; fits && i < on_.size(); ++i) {
    fits = start[i].next.size() == on_[i].next.size() && start[i].equalities.size() == on_[i].equalities.size() &&
           start[i].inequalities.size() == on_[i].inequalities.size();
  }
  return fits;
}

void InteriorPoint::start_slacks() {
  const double push = options_.start_is_near ? kNearPush : kFirstPush;
  if (!has_start_multipliers()) {
    slacks_.start(values_.inequalities, push);
    slacks_.center(mu_);
    slacks_.pull(mu_, lambda_);
    return;
  }
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    on_[i].next = cost_scale_ * options_.start_multipliers[i].next;
    on_[i].equalities = cost_scale_ * options_.start_multipliers[i].equalities;
    segment(lambda_, k) = cost_scale_ * options_.start_multipliers[i].inequalities;
  }
  slacks_.start(values_.inequalities, lambda_, mu_, push);
}

std::vector<StageMultipliers> InteriorPoint::multipliers() const {
  std::vector<StageMultipliers> result = on_;
  for (int k = 0; k < num_stages_; ++k) {
    StageMultipliers& on = result[static_cast<std::size_t>(k)];
    on.next /= cost_scale_;
    on.equalities /= cost_scale_;
    on.inequalities = segment(lambda_, k) / cost_scale_;
  }
  return result;
}

/// Least squares: those that leave the least violation of the dual equations.
void InteriorPoint::estimate_multipliers() {
  for (VectorXd& weights : weights_) weights.setZero();
  if (factorise(StageKkt::Hessian::identity, 1.0) != StageKkt::Outcome::solvable) return;
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    gradient_[i] = cost_scale_ * nlp_.cost_gradient(k);
    on_[i].inequalities = segment(lambda_, k);
    right_links_[i].setZero();
    right_equalities_[i].setZero();
    nlp_.add_pull_back(k, no_next_[i], on_[i].inequalities, gradient_[i]);
  }
  kkt_.solve(gradient_, right_equalities_, right_links_);
  const bool is_of_use = std::max(largest(kkt_.on_next()), largest(kkt_.on_equalities())) <= kLargestMultiplier;
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    on_[i].next = is_of_use ? kkt_.on_next()[i] : VectorXd::Zero(on_[i].next.size());
    on_[i].equalities = is_of_use ? kkt_.on_equalities()[i] : VectorXd::Zero(on_[i].equalities.size());
  }
}

double InteriorPoint::largest_multiplier() const {
  double result = 0.0;
  for (const StageMultipliers& on : on_) {
    result = std::max({result, on.next.lpNorm<Eigen::Infinity>(), on.equalities.lpNorm<Eigen::Infinity>()});
  }
  return result;
}

void InteriorPoint::set_right_sides(const Values& values, const VectorXd& s) {
  right_links_ = values.links;
  right_equalities_ = values.equalities;
  residual_ = values.inequalities - s;
}

/// Steps of all variables and new multipliers, for violations (right_links_, right_equalities_, residual).
void InteriorPoint::solve_direction(const VectorXd& residual) {
  const Stopwatch stopwatch(times_.linear_algebra);
  slacks_.pull(mu_, beta_);
  slacks_.weights(sigma_);
  step_lambda_ = beta_ + sigma_.cwiseProduct(residual);
  for (int k = 0; k < num_stages_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    gradient_[i] = cost_scale_ * nlp_.cost_gradient(k);
    on_[i].inequalities = segment(step_lambda_, k);
    nlp_.add_pull_back(k, no_next_[i], on_[i].inequalities, gradient_[i]);
  }
  kkt_.solve(gradient_, right_equalities_, right_links_);
  for (int k = 0; k < num_stages_; ++k) segment(ds_, k) = kkt_.along_inequalities()[static_cast<std::size_t>(k)];
  ds_ += residual;
  step_lambda_ = beta_ + sigma_.cwiseProduct(ds_);
}

bool InteriorPoint::compute_direction(double least_regularisation, std::string& failure) {
  slacks_.weights(sigma_);
  for (int k = 0; k < num_stages_; ++k) weights_[static_cast<std::size_t>(k)] = segment(sigma_, k);
  regularisation_ = least_regularisation;
  while (true) {
    const StageKkt::Outcome outcome = factorise(StageKkt::Hessian::lagrangian, regularisation_);
    if (outcome == StageKkt::Outcome::solvable) break;
    if (outcome == StageKkt::Outcome::not_finite) throw NumericalError("second derivatives are not finite");
    if (regularisation_ == 0.0) {
      regularisation_ = last_regularisation_ == 0.0 ? kFirstRegularisation
                                                    : std::max(kLeastRegularisation, kDecrease * last_regularisation_);
    } else {
      regularisation_ *= kGrowth;
    }
    if (regularisation_ > kLargestRegularisation) {
      failure = "no regularisation makes the problem convex";
      return false;
    }
  }
  // What a step that failed asks for says nothing of the curvature.
  if (regularisation_ > 0.0 && least_regularisation == 0.0) last_regularisation_ = regularisation_;

  set_right_sides(values_, slacks_.s);
  solve_direction(residual_);
  step_ = kkt_.steps();
  slacks_.set_step(mu_, ds_);
  slope_ = beta_.dot(ds_);
  for (int k = 0; k < num_stages_; ++k) {
    slope_ += cost_scale_ * nlp_.cost_gradient(k).dot(step_[static_cast<std::size_t>(k)]);
  }
  if (std::isfinite(slope_)) return true;
  failure = "the search direction is not finite";
  return false;
}

bool InteriorPoint::try_step(double alpha, const StageVectors& steps, const VectorXd& ds) {
  for (std::size_t i = 0; i < ux_.size(); ++i) trial_ux_[i] = ux_[i] + alpha * steps[i];
  if (!slacks_.move(s_, alpha, ds) || !evaluate(trial_ux_, trial_)) return false;
  slacks_.reset(s_, trial_.inequalities, std::max(kTauMin, 1.0 - mu_));
  return true;
}

bool InteriorPoint::is_acceptable(double alpha, double theta, double phi, bool& is_phi_step) const {
  if (!std::isfinite(theta) || !std::isfinite(phi) || !filter_.accepts(theta, phi)) return false;
  // Rounding of phi itself must not reject a step near the end.
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
    solve_direction(residual);
    alpha = slacks_.longest_primal(tau, ds_);
    bool is_phi_step = false;
    if (!try_step(alpha, kkt_.steps(), ds_)) break;
    const double now = violation(trial_, slacks_.s);
    if (is_acceptable(alpha, now, barrier_function(trial_, slacks_), is_phi_step)) {
      if (!is_phi_step) filter_.add((1.0 - kGammaTheta) * theta_, phi_ - kGammaPhi * theta_);
      ds_ = ds;  // the steps of the multipliers are those of the direction itself
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

bool InteriorPoint::search_line() {
  s_ = slacks_.s;
  theta_ = violation(values_, s_);
  phi_ = barrier_function(values_, slacks_);
  const double tau = std::max(kTauMin, 1.0 - mu_);
  const double longest = slacks_.longest_primal(tau, ds_), longest_dual = slacks_.longest_dual(tau);
  double least = kGammaTheta;
  if (slope_ < 0.0) {
    least = std::min(least, kGammaPhi * theta_ / -slope_);
    if (theta_ <= least_theta_) least = std::min(least, kDelta * std::pow(theta_, kSTheta) / std::pow(-slope_, kSPhi));
  }
  least = std::max(kGammaAlpha * least, kShortestStep);
  step_on_equalities_ = kkt_.on_equalities();
  step_on_next_ = kkt_.on_next();
  for (double alpha = longest; alpha > least; alpha *= 0.5) {
    const bool is_good = try_step(alpha, step_, ds_);
    const double theta = is_good ? violation(trial_, slacks_.s) : 0.0;
    bool is_phi_step = false;
    if (is_good && is_acceptable(alpha, theta, barrier_function(trial_, slacks_), is_phi_step)) {
      if (!is_phi_step) filter_.add((1.0 - kGammaTheta) * theta_, phi_ - kGammaPhi * theta_);
      accept(alpha, longest_dual);
      return true;
    }
    if (is_good && alpha == longest && theta >= theta_ && correct_second_order(alpha, theta)) {
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

/// Short steps towards the constraints, the cost left out, until the filter accepts where that leads. Else why not.
std::optional<InteriorPoint::Ending> InteriorPoint::restore_feasibility(const Watch& watch) {
  using enum SolveStatus;
  filter_.add((1.0 - kGammaTheta) * theta_, phi_ - kGammaPhi * theta_);
  const double theta_before = theta_;
  for (int i = 0; i < kMostRestorations; ++i) {
    if (i > 0) {
      if (auto ending = watch(++iterations_, figures_)) return ending;
    }
    slacks_.center(mu_);
    slacks_.weights(sigma_);
    for (int k = 0; k < num_stages_; ++k) weights_[static_cast<std::size_t>(k)] = segment(sigma_, k);
    if (factorise(StageKkt::Hessian::identity, std::sqrt(mu_)) != StageKkt::Outcome::solvable) {
      return Ending{solver_failed, "restoration of feasibility: its equations are singular"};
    }
    set_right_sides(values_, slacks_.s);
    const double cost_scale = cost_scale_;
    cost_scale_ = 0.0;
    solve_direction(residual_);
    cost_scale_ = cost_scale;
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
        return Ending{solver_failed, "no step along the search direction is an improvement"};
      }
      return Ending{infeasible, "converged to a point of locally least violation"};
    }
    ux_.swap(trial_ux_);
    std::swap(values_, trial_);
    linearise();
    largest_dual_violation_ = std::numeric_limits<double>::infinity();  // not looked at here
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
  return Ending{solver_failed, fmt::format("restoration of feasibility: no end in {} steps", kMostRestorations)};
}

InteriorPoint::Ending InteriorPoint::run(const StageVectors& start, const Watch& watch) {
  using enum SolveStatus;
  ux_ = start;
  if (!evaluate(ux_, values_)) return {evaluation_failed, failure_};
  mu_ = (has_start_multipliers() ? kKnownBarrier : options_.start_is_near ? kNearBarrier : kFirstBarrier) / num_stages_;
  try {
    scale_cost();
    start_slacks();
    if (!has_start_multipliers()) estimate_multipliers();
    linearise();
    theta_ = violation(values_, slacks_.s);
    least_theta_ = 1e-4 * std::max(1.0, theta_);
    const double largest_theta = 1e4 * std::max(1.0, theta_);
    filter_.reset(largest_theta);
    for (iterations_ = 0;; ++iterations_) {
      update_dual_violation();
      update_figures();
      if (!std::isfinite(figures_.dual_violation)) return {evaluation_failed, "the iterate is not finite"};
      if (error(0.0) <= options_.tolerance && figures_.violation <= options_.tolerance) {
        return {converged, "optimal within tolerance"};
      }
      if (const auto ending = watch(iterations_, figures_)) return *ending;
      bool new_barrier = false;
      while (update_barrier()) new_barrier = true;
      if (new_barrier) filter_.reset(largest_theta);
      std::string failure;
      bool has_moved = false;
      double least_regularisation = 0.0;
      for (int failures = 0; !has_moved && failures <= kMostFailures; ++failures) {
        if (!compute_direction(least_regularisation, failure)) return {solver_failed, failure};
        has_moved = search_line();
        least_regularisation = kFailureGrowth * std::max(kFirstRegularisation, regularisation_);
      }
      if (!has_moved) {
        if (const auto ending = restore_feasibility(watch)) return *ending;
        continue;
      }
      linearise();
      const bool violation_is_small = largest_violation(values_, slacks_.s) < kNearlyFeasible;
      // A regularised step that removes a violation leaves multipliers in proportion to the regularisation, and these bend
      // the Lagrangian, which asks for more of it.
      if (regularisation_ > 0.0 && violation_is_small && largest_multiplier() > kHugeMultiplier) {
        estimate_multipliers();
        linearise();
      }
    }
  } catch (const NumericalError& error) {
    return {evaluation_failed, error.what()};
  }
}

}  // namespace prowl

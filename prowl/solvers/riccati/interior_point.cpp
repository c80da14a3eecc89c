#include "prowl/solvers/riccati/interior_point.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <stdexcept>
#include <utility>

#include "prowl/error.hpp"
#include "prowl/nlp/stopwatch.hpp"

namespace prowl {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

// Named as in Wächter and Biegler 2006.
constexpr double kKappaEpsilon = 10.0, kKappaMu = 0.2, kThetaMu = 1.5, kSMax = 100.0;
constexpr double kLargestRegularisation = 1e20, kLeastRegularisation = 1e-20;

constexpr double kFirstRegularisation = 1e-2, kGrowth = 8.0, kDecrease = 1.0 / 3.0;
constexpr double kLargestEstimate = 1e3;  ///< larger estimates are discarded
constexpr double kNearlyFeasibleRows = 1e-2, kHugeMultiplier = 1e5;
/// Multipliers grow without bound where constraints conflict. A cost is about 1 at a solution: above this a violation
/// of 1e-10 would cost as much. Of 27 tasks and 70 gaits that were solved, none came above 4e7.
constexpr double kUnboundedMultiplier = 1e10;
constexpr double kLargestCostSlope = 100.0;
/// Residual of Newton's equations over the tolerance, and over the error of the iterate: far from the solution the next
/// error is that of the linearisation, and refining the step costs as much as half a factorisation.
constexpr double kStepAccuracy = 1e-2, kFarStepAccuracy = 1e-4;

/// First mu times the number of stages. The cost is an integral, the barrier a sum over stages: for
/// equal weights on each mesh mu must scale with the step (HyQ rear, cold start, 350 intervals: 59
/// iterations with mu = 1e-3, 22 with this; 23 intervals: 16 and 16). Near a solution with known
/// multipliers these place the slacks, and mu can start near its final value: HyQ balance with the
/// goal moved by 2 cm takes 7 iterations with 3e-4 and 4 with 3e-5 (medians).
constexpr double kFirstBarrier = 3e-2, kNearBarrier = 3e-3, kKnownBarrier = 3e-5;
/// Until mu falls for the first time, a step that the nearest bound cuts to less than this share shows a barrier too
/// weak to keep the motion off its bounds: mu grows, up to so many times the first one. HyQ walk, 4 strides of 1.2 m:
/// 195 iterations instead of 417.
constexpr double kCutShort = 0.05, kBarrierGrowth = 3.0, kMostGrowth = 10.0;
constexpr double kFirstPush = 1e-2, kNearPush = 1e-4;  ///< distance of slacks from their bounds
/// Along directions in which the cost hardly changes, or bends down a little, regularised steps take hundreds of
/// iterations for the last digits of the gradient: after so many feasible iterates with an error within so many times
/// the tolerance, mu being within it, the solve ends.
constexpr double kNearTolerance = 100.0;
constexpr int kMostNearIterates = 10;
/// If no fraction of a step is acceptable: regularise more, at most so many times.
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
    all.segment(rows[k], nlp.size(k).inequalities) = bound(k);
  }
  return all;
}

double sum_of_sizes(const StageVectors& vectors) {
  double result = 0.0;
  for (const VectorXd& v : vectors) result += v.lpNorm<1>();
  return result;
}

}  // namespace

InteriorPoint::InteriorPoint(StagewiseNlp& nlp, const SolverOptions& options, int threads)
    : nlp_(nlp),
      options_(options),
      threads_(threads),
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
  step_on_next_ = right_links_;
  for (Values* values : {&values_, &trial_}) {
    values->stage_costs.setZero(num_stages_);
    values->links = right_links_;
    values->equalities = right_equalities_;
    values->inequalities.setZero(rows_.back());
  }
  for (VectorXd* v : {&s_, &ds_, &lambda_, &beta_, &sigma_, &residual_, &step_lambda_}) v->setZero(rows_.back());
}

/// Calls function() and adds the stage to its NumericalError: functions of a stage know neither
/// phase nor time.
template <class Function>
void InteriorPoint::at_stage(int k, Function function) const {
  try {
    function();
  } catch (const NumericalError& error) {
    throw NumericalError(fmt::format("{}: {}", nlp_.describe_stage(k), error.what()));
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("{}: {}", nlp_.describe_stage(k), error.what()));
  }
}

bool InteriorPoint::evaluate(const StageVectors& ux, Values& values) {
  const Stopwatch stopwatch(times_.values);
  try {
    threads_.for_each(num_stages_, [&](int k) { at_stage(k, [&] { evaluate_stage(k, ux, values); }); });
  } catch (const NumericalError& error) {
    failure_ = error.what();
    return false;
  }
  values.cost = values.stage_costs.sum();
  const Eigen::MatrixXd& closure = nlp_.closure();
  if (closure.rows() > 0) values.equalities.back().tail(closure.rows()).noalias() += closure * ux.front();
  return true;
}

void InteriorPoint::evaluate_stage(int k, const StageVectors& ux, Values& values) {
  const StageValues& stage = nlp_.values(k, ux[k]);
  values.stage_costs(k) = stage.cost;
  values.equalities[k] = stage.equalities;
  segment(values.inequalities, k) = stage.inequalities;
  if (k + 1 < num_stages_) values.links[k] = stage.next - ux[k + 1].tail(stage.next.size());
  if (!std::isfinite(stage.cost)) throw NumericalError("the cost is not finite");
  if (!stage.equalities.allFinite()) throw NumericalError("an equality is not finite");
  if (!stage.inequalities.allFinite()) throw NumericalError("an inequality is not finite");
  if (!stage.next.allFinite()) throw NumericalError("the next state is not finite");
}

/// Other non-finite derivatives are found where they are used; these would spread to all stages
/// first.
void InteriorPoint::need_finite_slopes(int k) const {
  if (!nlp_.cost_gradient(k).allFinite()) throw NumericalError("the gradient of the cost is not finite");
  if (!is_finite(nlp_.equality_slopes(k))) throw NumericalError("the derivatives of an equality are not finite");
}

void InteriorPoint::linearise() {
  const Stopwatch stopwatch(times_.derivatives);
  is_linearised_anew_ = true;
  threads_.for_each(num_stages_, [this](int k) {
    on_[k].inequalities = segment(lambda_, k);
    at_stage(k, [&] {
      nlp_.linearise(k, ux_[k], cost_scale_, on_[k]);
      need_finite_slopes(k);
    });
  });
}

/// Without second derivatives.
void InteriorPoint::linearise_to_first_order() {
  const Stopwatch stopwatch(times_.derivatives);
  is_linearised_anew_ = true;
  threads_.for_each(num_stages_, [this](int k) {
    at_stage(k, [&] {
      nlp_.linearise_to_first_order(k, ux_[k]);
      need_finite_slopes(k);
    });
  });
}

StageKkt::Outcome InteriorPoint::factorise(StageKkt::Hessian hessian, double delta) {
  const Stopwatch stopwatch(times_.linear_algebra);
  if (std::exchange(is_linearised_anew_, false)) kkt_.determine_inputs();
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
    VectorXd& violation = dual_violation_[k];
    violation = cost_scale_ * nlp_.cost_gradient(k);
    violation.noalias() += nlp_.equality_slopes(k).transpose() * on_[k].equalities;
    on_[k].inequalities = segment(lambda_, k);
    nlp_.add_pull_back(k, on_[k].next, on_[k].inequalities, violation);
    if (k > 0) violation.tail(nlp_.size(k).states) -= on_[k - 1].next;
    if (const Eigen::MatrixXd& closure = nlp_.closure(); k == 0 && closure.rows() > 0)
      violation.noalias() += closure.transpose() * on_.back().equalities.tail(closure.rows());
    if (!violation.allFinite()) throw NumericalError(nlp_.describe_stage(k) + ": first derivatives are not finite");
    if (violation.size() > 0)
      largest_dual_violation_ = std::max(largest_dual_violation_, violation.cwiseAbs().maxCoeff());
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
  has_barrier_fallen_ = true;
  return true;
}

bool InteriorPoint::raise_barrier() {
  const double most = kMostGrowth * kFirstBarrier / num_stages_;
  if (iterations_ == 0 || has_barrier_fallen_ || longest_ >= kCutShort || mu_ >= most) return false;
  mu_ = std::min(most, kBarrierGrowth * mu_);
  return true;
}

std::optional<InteriorPoint::Ending> InteriorPoint::has_converged(const Test& is_feasible) {
  const double error = this->error(0.0);
  if (error > kNearTolerance * options_.tolerance || figures_.violation > options_.tolerance) return std::nullopt;
  const bool is_optimal = error <= options_.tolerance;
  if (mu_ <= options_.tolerance) ++near_iterates_;
  if ((near_iterates_ < kMostNearIterates && !is_optimal) || !is_feasible(ux_)) return std::nullopt;
  if (is_optimal) return Ending{SolveStatus::converged, "optimal within tolerance"};
  return Ending{SolveStatus::converged,
                fmt::format("optimal within {:g} times the tolerance, in {} iterates", kNearTolerance, near_iterates_)};
}

void InteriorPoint::scale_cost() {
  cost_scale_ = 1.0;
  linearise_to_first_order();
  double slope = 0.0;
  for (int k = 0; k < num_stages_; ++k) {
    if (nlp_.cost_gradient(k).size() > 0) slope = std::max(slope, nlp_.cost_gradient(k).cwiseAbs().maxCoeff());
  }
  if (slope > kLargestCostSlope) cost_scale_ = kLargestCostSlope / slope;
}

bool InteriorPoint::has_warm_start_multipliers() const {
  const std::vector<StageMultipliers>& given = options_.warm_start_multipliers;
  bool fits = options_.is_warm_start && given.size() == on_.size();
  for (std::size_t i = 0; fits && i < on_.size(); ++i) {
    fits = given[i].next.size() == on_[i].next.size() && given[i].equalities.size() == on_[i].equalities.size() &&
           given[i].inequalities.size() == on_[i].inequalities.size();
  }
  return fits;
}

void InteriorPoint::initialise_slacks() {
  const double push = options_.is_warm_start ? kNearPush : kFirstPush;
  if (!has_warm_start_multipliers()) {
    slacks_.initialise(values_.inequalities, push);
    slacks_.center(mu_);
    slacks_.pull(mu_, lambda_);
    return;
  }
  for (int k = 0; k < num_stages_; ++k) {
    on_[k].next = cost_scale_ * options_.warm_start_multipliers[k].next;
    on_[k].equalities = cost_scale_ * options_.warm_start_multipliers[k].equalities;
    segment(lambda_, k) = cost_scale_ * options_.warm_start_multipliers[k].inequalities;
  }
  slacks_.initialise(values_.inequalities, lambda_, mu_, push);
}

std::vector<StageMultipliers> InteriorPoint::multipliers() const {
  std::vector<StageMultipliers> result = on_;
  for (int k = 0; k < num_stages_; ++k) {
    StageMultipliers& on = result[k];
    on.next /= cost_scale_;
    on.equalities /= cost_scale_;
    on.inequalities = segment(lambda_, k) / cost_scale_;
  }
  return result;
}

/// Least-squares estimate: minimises the violation of the dual equations.
void InteriorPoint::estimate_multipliers() {
  for (VectorXd& weights : weights_) weights.setZero();
  if (factorise(StageKkt::Hessian::identity, 1.0) != StageKkt::Outcome::solvable) return;
  set_gradient(cost_scale_, lambda_);
  for (VectorXd& links : right_links_) links.setZero();
  for (VectorXd& equalities : right_equalities_) equalities.setZero();
  kkt_.solve(gradient_, right_equalities_, right_links_);
  const bool is_of_use = std::max(largest(kkt_.on_next()), largest(kkt_.on_equalities())) <= kLargestEstimate;
  for (int k = 0; k < num_stages_; ++k) {
    on_[k].next = is_of_use ? kkt_.on_next()[k] : VectorXd::Zero(on_[k].next.size());
    on_[k].equalities = is_of_use ? kkt_.on_equalities()[k] : VectorXd::Zero(on_[k].equalities.size());
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

/// Gradient of cost_scale cost + lambda . inequalities.
void InteriorPoint::set_gradient(double cost_scale, const VectorXd& lambda) {
  for (int k = 0; k < num_stages_; ++k) {
    gradient_[k] = cost_scale * nlp_.cost_gradient(k);
    on_[k].inequalities = segment(lambda, k);
    nlp_.add_pull_back(k, no_next_, on_[k].inequalities, gradient_[k]);
  }
}

void InteriorPoint::set_weights() {
  slacks_.weights(sigma_);
  for (int k = 0; k < num_stages_; ++k) weights_[k] = segment(sigma_, k);
}

/// Steps of all variables and new multipliers from the current factors and weights, for the
/// violations right_links_, right_equalities_ and `residual`.
void InteriorPoint::solve_direction(double cost_scale, const VectorXd& residual) {
  const Stopwatch stopwatch(times_.linear_algebra);
  slacks_.pull(mu_, beta_);
  step_lambda_ = beta_ + sigma_.cwiseProduct(residual);
  set_gradient(cost_scale, step_lambda_);
  const double far = kFarStepAccuracy * error(0.0);  // infinite during a restoration, which evaluates no dual violation
  const double accuracy = std::max(kStepAccuracy * options_.tolerance, std::isfinite(far) ? far : 0.0);
  kkt_.solve(gradient_, right_equalities_, right_links_, accuracy);
  for (int k = 0; k < num_stages_; ++k) segment(ds_, k) = kkt_.along_inequalities()[k];
  ds_ += residual;
  step_lambda_ = beta_ + sigma_.cwiseProduct(ds_);
}

bool InteriorPoint::compute_direction(double least_regularisation, std::string& failure) {
  set_weights();
  regularisation_ = least_regularisation;
  while (true) {
    const StageKkt::Outcome outcome = factorise(StageKkt::Hessian::lagrangian, regularisation_);
    if (outcome == StageKkt::Outcome::solvable) break;
    if (outcome == StageKkt::Outcome::not_finite) {
      throw NumericalError(nlp_.describe_stage(kkt_.last_stage()) + ": second derivatives are not finite");
    }
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
  // Regularisation after a failed step does not measure the curvature.
  if (regularisation_ > 0.0 && least_regularisation == 0.0) last_regularisation_ = regularisation_;

  set_right_sides(values_, slacks_.s);
  solve_direction(cost_scale_, residual_);
  step_ = kkt_.steps();
  slacks_.set_step(mu_, ds_);
  slope_ = beta_.dot(ds_);
  for (int k = 0; k < num_stages_; ++k) {
    slope_ += cost_scale_ * nlp_.cost_gradient(k).dot(step_[k]);
  }
  if (std::isfinite(slope_)) return true;
  failure = "the search direction is not finite";
  return false;
}

InteriorPoint::Ending InteriorPoint::run(const StageVectors& guess, const Watch& watch, const Test& is_feasible) {
  using enum SolveStatus;
  ux_ = guess;
  if (!evaluate(ux_, values_)) return {evaluation_failed, failure_};
  mu_ = (has_warm_start_multipliers() ? kKnownBarrier
         : options_.is_warm_start     ? kNearBarrier
                                      : kFirstBarrier) /
        num_stages_;
  try {
    scale_cost();
    initialise_slacks();
    if (!has_warm_start_multipliers()) estimate_multipliers();
    linearise();
    theta_ = violation(values_, slacks_.s);
    least_theta_ = 1e-4 * std::max(1.0, theta_);
    const double largest_theta = 1e4 * std::max(1.0, theta_);
    filter_.reset(largest_theta);
    if (has_warm_start_multipliers()) keep_point();
    for (iterations_ = 0;; ++iterations_) {
      end_whole_steps();
      update_dual_violation();
      update_figures();
      if (!std::isfinite(figures_.dual_violation)) return {evaluation_failed, "the iterate is not finite"};
      if (const auto ending = has_converged(is_feasible)) return *ending;
      if (figures_.violation > options_.tolerance && largest_multiplier() > kUnboundedMultiplier)
        return {infeasible, "the constraints conflict: their multipliers grow without bound"};
      if (const auto ending = watch(iterations_, figures_)) return *ending;
      bool new_barrier = raise_barrier();
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
      const bool violation_is_small = largest_violation(values_, slacks_.s) < kNearlyFeasibleRows;
      // A regularised step that removes a violation leaves multipliers proportional to the
      // regularisation. They distort the Lagrangian, which then needs even more regularisation.
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

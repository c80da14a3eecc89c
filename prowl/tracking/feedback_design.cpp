#include "prowl/tracking/feedback_design.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <span>

#include "prowl/error.hpp"
#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/riccati_flow.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

// docs/tracking.md#riccati-equation.
constexpr double kStanceLegs = 0.1;  ///< share of the weight on their joints that finds the nearest allowed deviation
constexpr double kFading = 1.2;      ///< of the impedance after a landing, in times sqrt(standing height / gravity)

/// Dynamics at one sample, reduced to the deviations that its contacts allow.
struct Reduced {
  MatrixXd Z, A, B;
  MatrixXd Q;  ///< cost of a deviation per second, xi' Q xi
};

/// `swing`: displacements of the feet in the air per deviation, over those that cost 1 (rows x nv).
Reduced reduce(const LinearisedDynamics& linear, const VectorXd& weight, const MatrixXd& swing, MatrixXd Z) {
  const MatrixXd left = Z.transpose() * weight.asDiagonal();
  const MatrixXd feet = swing * Z.topRows(swing.cols());
  const MatrixXd identity = MatrixXd::Identity(Z.cols(), Z.cols());
  return {Z, left * linear.A() * Z, left * linear.B(), identity + feet.transpose() * feet};
}

/// `Z` rotated within its space to be closest to the basis of the next sample. Along a phase the
/// basis then rotates only with the space: Z' W dZ/dt = 0. Polar factor of Z' W next by Newton's
/// iteration: Higham, Functions of Matrices, 2008, section 8.3.
MatrixXd aligned(const MatrixXd& Z, const MatrixXd& next, const VectorXd& weight) {
  MatrixXd turn = Z.transpose() * weight.asDiagonal() * next;
  const MatrixXd identity = MatrixXd::Identity(turn.rows(), turn.cols());
  for (int i = 0; i < 20; ++i) {
    const MatrixXd gram = turn.transpose() * turn;
    if ((gram - identity).norm() < 1e-13 * static_cast<double>(turn.rows())) break;
    turn = (0.5 * turn * (3.0 * identity - gram)).eval();
  }
  return Z * turn;
}

/// Largest and mean singular value, and the dominant coordinate of the worst initial deviation.
void fill_decay(const RobotModel& robot, const MatrixXd& transition, const MatrixXd& Z, const VectorXd& weight,
                PhaseDecay& decay) {
  const SymmetricEigen gram = symmetric_eigen(transition.transpose() * transition);
  const Eigen::Index largest = Z.cols() - 1;
  decay.directions = static_cast<int>(Z.cols());
  decay.worst = std::sqrt(gram.values(largest));
  decay.mean = transition.norm() / std::sqrt(static_cast<double>(Z.cols()));
  Eigen::Index leading = 0;
  (weight.cwiseSqrt().asDiagonal() * (Z * gram.vectors.col(largest))).cwiseAbs().maxCoeff(&leading);
  decay.worst_direction = state_name(robot, leading);
}

/// Backward pass from the end of the motion to its start, sample by sample.
class BackwardPass {
 public:
  BackwardPass(const MotionProblem& problem, const TrackingOptions& options, bool has_phase_after_end,
               FeedbackDesign& design, const std::function<void(const ReducedSample&)>& on_sample)
      : robot_(problem.robot),
        goals_(std::span(problem.boundary_constraints).subspan(1)),
        end_(PhaseFraction::end_of(static_cast<int>(problem.phases.size()) - 1)),
        options_(options),
        has_phase_after_end_(has_phase_after_end),
        design_(design),
        on_sample_(on_sample),
        weight_(options.state_weight()),
        control_weight_(options.torque_weight().cwiseInverse()) {}

  void run() {
    design_.gains.resize(design_.phases.size());
    for (std::size_t p = design_.phases.size(); p-- > 0;) run_phase(p);
    std::reverse(design_.decay.begin(), design_.decay.end());
    design_.whole.name = "all";
    design_.whole.start = design_.phases.front().start();
    fill_decay(robot_, whole_, now_.Z, weight_, design_.whole);
  }

 private:
  void run_phase(std::size_t p) {
    const ReferencePhase& phase = design_.phases[p];
    LinearisedDynamics linear(robot_, phase.contacts);
    design_.gains[p].resize(phase.samples.size());
    MatrixXd transition;
    for (std::size_t k = phase.samples.size(); k-- > 0;) {
      const TrajectoryPoint& point = phase.samples[k];
      linear.evaluate(point.q, point.v, point.tau);
      const MatrixXd Z = linear.consistent_directions(weight_);
      const MatrixXd swing = swing_feet(p, point.q);
      if (Z.cols() == 0) {
        throw NumericalError(
            fmt::format("no feedback gains in phase \"{}\": its contacts allow no motion", phase.name));
      }
      MatrixXd step;
      if (k + 1 == phase.samples.size()) {
        step = p + 1 < design_.phases.size() ? land(reduce(linear, weight_, swing, Z))
                                             : begin_at_end(reduce(linear, weight_, swing, Z));
        transition = step;
      } else if (Z.cols() == now_.Z.cols()) {
        step = step_back(reduce(linear, weight_, swing, aligned(Z, now_.Z, weight_)), phase.step());
        transition = (transition * step).eval();
      } else {
        throw NumericalError(
            fmt::format("no feedback gains in phase \"{}\": at t = {:.3f} s the rank of its contacts changes "
                        "(a leg is straight)",
                        phase.name, point.time));
      }
      reach_goals(p, k);
      if (!S_.allFinite()) {
        throw NumericalError(
            fmt::format("no feedback gains in phase \"{}\" at t = {:.3f} s: the Riccati equation is not finite",
                        phase.name, point.time));
      }
      design_.gains[p][k] = gain_ * allowed_part(linear) + linear.impedance(impedance_rates(p, point.time));
      if (on_sample_)
        on_sample_({static_cast<int>(p), static_cast<int>(k), now_.Z, now_.A, now_.B, now_.Q, S_, design_.gains[p][k],
                    step, point, linear});
    }
    record(p, transition);
    if (p > 0) landing_ = linear.landing(linear.with_stance_legs(weight_, kStanceLegs));
  }

  bool holds(std::size_t p, int contact) const { return std::ranges::count(design_.phases[p].contacts, contact) > 0; }

  /// Adds the cost of deviations from goals of the configuration at sample k of phase p. Not at the end of all: there S
  /// is that of standing on.
  void reach_goals(std::size_t p, std::size_t k) {
    const auto last = static_cast<double>(design_.phases[p].samples.size() - 1);
    for (const BoundaryConstraint& goal : goals_) {
      if (goal.at == end_) continue;
      if (goal.at.phase != static_cast<int>(p) || std::lround(goal.at.fraction * last) != static_cast<long>(k))
        continue;
      const auto is_bounded = [&](Eigen::Index i) {
        return i < robot_.nv() &&
               (std::isfinite(goal.configuration_lower(i)) || std::isfinite(goal.configuration_upper(i)));
      };
      VectorXd weight = options_.goal_time * weight_;
      for (Eigen::Index i = 0; i < weight.size(); ++i) weight(i) *= is_bounded(i);
      S_ += now_.Z.transpose() * weight.asDiagonal() * now_.Z;
      set_gain();
    }
  }

  /// Displacements by dq of the feet that are in the air and will land, over the one that costs 1 (rows x nv).
  MatrixXd swing_feet(std::size_t p, const VectorXd& q) {
    std::vector<int> feet;
    for (int contact = 0; contact < static_cast<int>(robot_.contacts().size()); ++contact) {
      std::size_t next = p;
      while (next < design_.phases.size() && !holds(next, contact)) ++next;
      if (next > p && next < design_.phases.size()) feet.push_back(contact);
    }
    if (feet.empty()) return MatrixXd::Zero(0, robot_.nv());
    ContactKinematics kinematics(feet);
    terms_.update_kinematics(q);
    kinematics.set_configuration(terms_);
    return kinematics.positions_dq() / options_.swing_foot_deviation;
  }

  /// xi of a measured deviation (n x 2 nv): of the nearest that the contacts allow.
  MatrixXd allowed_part(const LinearisedDynamics& linear) const {
    const VectorXd metric = linear.with_stance_legs(weight_, kStanceLegs);
    const MatrixXd left = now_.Z.transpose() * metric.asDiagonal();
    return MatrixXd(left * now_.Z).llt().solve(left);
  }

  /// Of the impedance of each contact in stance [1/s]: the largest bandwidth when it lands. It fades, since a foot that
  /// holds elsewhere should stay there.
  VectorXd impedance_rates(std::size_t p, double time) const {
    const std::vector<int>& contacts = design_.phases[p].contacts;
    const double fading = kFading * std::sqrt(robot_.nominal_configuration().z() / RobotModel::kGravity);
    VectorXd result = VectorXd::Zero(static_cast<Eigen::Index>(contacts.size()));
    for (std::size_t i = 0; i < contacts.size(); ++i) {
      std::size_t first = p;
      while (first > 0 && holds(first - 1, contacts[i])) --first;
      if (first == 0) continue;  // stands from the start
      const double left = 1.0 - (time - design_.phases[first].start()) / fading;
      result(static_cast<Eigen::Index>(i)) = std::max(0.0, left) * options_.largest_bandwidth;
    }
    return result;
  }

  /// Records the decay of a phase, except for the one after the end of the motion.
  void record(std::size_t p, const MatrixXd& transition) {
    const bool after_end = has_phase_after_end_ && p + 1 == design_.phases.size();
    if (!after_end) {
      PhaseDecay& decay = design_.decay.emplace_back();
      decay.name = design_.phases[p].name;
      decay.start = design_.phases[p].start();
      decay.end = design_.phases[p].end();
      decay.bandwidth = bandwidth_;
      design_.whole.end = std::max(design_.whole.end, decay.end);
      design_.whole.bandwidth = std::max(design_.whole.bandwidth, bandwidth_);
      fill_decay(robot_, transition, now_.Z, weight_, decay);
    }
    whole_ = after_end || whole_.size() == 0 ? transition : MatrixXd(whole_ * transition);
    bandwidth_ = 0.0;
  }

  /// Feedback dtau = -gain xi from S at the latest sample, with limited bandwidth. The loop from
  /// torque to torque is gain (s I - A)⁻¹ B; in R^(1/2) dtau at high frequencies F' S F / s with F
  /// = B R^(-1/2). The eigenvalues of F' S F are its crossover frequencies.
  void set_gain() {
    const VectorXd root = control_weight_.cwiseSqrt();
    const MatrixXd F = now_.B * root.asDiagonal();
    const MatrixXd feedback = F.transpose() * S_;
    const MatrixXd loop = feedback * F;
    const double limit = options_.largest_bandwidth;
    is_limited_ = false;
    gain_ = root.asDiagonal() * feedback;
    if (!loop.allFinite()) return;
    const auto [rates, U] = symmetric_eigen(loop);
    bandwidth_ = std::max(bandwidth_, std::min(rates(rates.size() - 1), limit));
    if (rates(rates.size() - 1) <= limit) return;
    is_limited_ = true;
    const VectorXd share = rates.unaryExpr([&](double rate) { return rate > limit ? limit / rate : 1.0; });
    gain_ = root.asDiagonal() * U * share.asDiagonal() * U.transpose() * feedback;
  }

  /// S at the end: of standing for ever in the final posture or, if impossible, for one second.
  MatrixXd begin_at_end(Reduced end) {
    now_ = std::move(end);
    RiccatiFlow flow = riccati_flow(now_.A, control_of(now_.B), now_.Q, options_.step);
    const std::optional<MatrixXd> stationary = stationary_cost(flow);
    design_.stands_on = has_phase_after_end_ && stationary;
    if (stationary) {
      S_ = *stationary;
    } else {
      for (double time = options_.step; time < 1.0; time *= 2.0) flow = compose(flow, flow);
      S_ = flow.cost;
    }
    set_gain();
    if (stationary) {
      const Eigen::VectorXcd poles = eigenvalues(now_.A - now_.B * gain_);
      design_.slowest_rate = -poles.real().maxCoeff();
      design_.fastest_rate = poles.cwiseAbs().maxCoeff();
      // The limited bandwidth may leave gains too small to stabilise.
      design_.stands_on = design_.stands_on && design_.slowest_rate > 0.0;
    }
    return MatrixXd::Identity(now_.A.rows(), now_.A.rows());
  }

  /// S before the transition to the later phase, whose first sample is current; returns the effect
  /// of the transition on deviations.
  MatrixXd land(Reduced before) {
    const MatrixXd landed = landing_ * before.Z;
    const MatrixXd jump = now_.Z.transpose() * weight_.asDiagonal() * landed;
    const Eigen::Index nv = robot_.nv();
    const MatrixXd lost = weight_.head(nv).cwiseSqrt().asDiagonal() * (before.Z - landed).topRows(nv);
    S_ = jump.transpose() * S_ * jump;
    S_ += options_.landing_time * lost.transpose() * lost;
    now_ = std::move(before);
    set_gain();
    return jump;
  }

  MatrixXd step_back(Reduced left, double h) {
    const MatrixXd A = 0.5 * (left.A + now_.A), B = 0.5 * (left.B + now_.B);
    const RiccatiFlow flow = riccati_flow(A, control_of(B), 0.5 * (left.Q + now_.Q), h);
    MatrixXd optimal = flow.closed_loop(S_);
    const MatrixXd gain_at_end = gain_;
    const bool was_limited = is_limited_;
    S_ = flow.back(S_);
    now_ = std::move(left);
    set_gain();
    if (!is_limited_ && !was_limited) return optimal;
    return exponential(h * (A - 0.5 * B * (gain_ + gain_at_end)));
  }

  MatrixXd control_of(const MatrixXd& B) const { return B * control_weight_.asDiagonal() * B.transpose(); }

  const RobotModel& robot_;
  const std::span<const BoundaryConstraint> goals_;
  const PhaseFraction end_;
  RigidBodyTerms terms_{robot_};
  const TrackingOptions& options_;
  bool has_phase_after_end_;
  FeedbackDesign& design_;
  const std::function<void(const ReducedSample&)>& on_sample_;
  VectorXd weight_, control_weight_;  // W; R⁻¹
  Reduced now_;                       // at the latest sample
  MatrixXd S_, gain_;                 // likewise; dtau = -gain xi
  bool is_limited_ = false;
  double bandwidth_ = 0.0;  // largest of the phase so far
  MatrixXd landing_;        // at the first sample of the latest phase
  MatrixXd whole_;          // deviation there -> at the end
};

}  // namespace

std::optional<ReferencePhase> stand_on(const RobotModel& robot, const ReferencePhase& last,
                                       const TrackingOptions& options) {
  TrajectoryPoint rest = last.samples.back();
  rest.v.setZero();
  ForwardDynamics dynamics(robot, last.contacts, kContactRankThreshold);
  dynamics.evaluate_with_derivatives(rest.q, rest.v, rest.tau);
  // a = a0 + D dtau is exact; take the dtau of smallest weight with a = 0.
  const VectorXd scale = options.torque_deviation;
  const MatrixXd D = dynamics.acceleration_derivatives().tau * scale.asDiagonal();
  rest.tau -= scale.asDiagonal() * least_norm_solution(D, dynamics.acceleration(), 1e-8);
  rest.a.setZero();
  dynamics.evaluate(rest.q, rest.v, rest.tau);
  constexpr double kStill = 1e-6;  // of gravity
  if (dynamics.acceleration().norm() > kStill * RobotModel::kGravity) return std::nullopt;

  ReferencePhase after{"stand on", last.contacts, {rest, rest}};
  after.samples.back().time += options.step;
  return after;
}

FeedbackDesign design_feedback(const MotionProblem& problem, const Trajectory& trajectory,
                               const TrackingOptions& options,
                               const std::function<void(const ReducedSample&)>& on_sample) {
  const auto begin = std::chrono::steady_clock::now();
  FeedbackDesign design;
  design.phases = reference_grid(problem, trajectory, options.step);
  std::optional<ReferencePhase> after = stand_on(problem.robot, design.phases.back(), options);
  if (after) design.phases.push_back(std::move(*after));
  BackwardPass(problem, options, after.has_value(), design, on_sample).run();
  design.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return design;
}

}  // namespace prowl

#include "prowl/tracking/feedback_design.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>

#include "prowl/error.hpp"
#include "prowl/tracking/linearised_dynamics.hpp"
#include "prowl/tracking/riccati_flow.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// The dynamics at one sample on the deviations that its contacts allow.
struct Reduced {
  MatrixXd Z, A, B;
};

Reduced reduce(const LinearisedDynamics& linear, const VectorXd& weight, MatrixXd Z) {
  const MatrixXd left = Z.transpose() * weight.asDiagonal();
  return {Z, left * linear.A() * Z, left * linear.B()};
}

/// `Z` turned within its space to lie as near as can be to the basis of the next sample, so that along a phase the basis
/// turns only as much as the space itself does (its own turning, Z' W dZ/dt, then is zero). The polar factor of Z' W next
/// by Newton's iteration: Higham, Functions of Matrices, 2008, section 8.3.
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

/// Largest and mean singular value, and the coordinate that leads in the worst initial deviation.
void fill_decay(const RobotModel& robot, const MatrixXd& transition, const MatrixXd& Z, const VectorXd& weight,
                PhaseDecay& decay) {
  const Eigen::BDCSVD<MatrixXd> svd(transition, Eigen::ComputeThinV);
  decay.directions = static_cast<int>(Z.cols());
  decay.worst = svd.singularValues()(0);
  decay.mean = transition.norm() / std::sqrt(static_cast<double>(Z.cols()));
  Eigen::Index leading = 0;
  (weight.cwiseSqrt().asDiagonal() * (Z * svd.matrixV().col(0))).cwiseAbs().maxCoeff(&leading);
  decay.worst_direction = state_name(robot, leading);
}

/// The backward pass: from the end of the motion to its start, one sample after the other.
class BackwardPass {
 public:
  BackwardPass(const MotionProblem& problem, const TrackingOptions& options, FeedbackDesign& design,
               const std::function<void(const ReducedSample&)>& on_sample)
      : robot_(problem.robot), options_(options), design_(design), on_sample_(on_sample), weight_(options.state_weight()),
        control_weight_(options.torque_weight().cwiseInverse()) {}

  void run() {
    design_.gains.resize(design_.phases.size());
    design_.decay.resize(design_.phases.size());
    for (std::size_t p = design_.phases.size(); p-- > 0;) run_phase(p);
    design_.whole = {.name = "all", .start = design_.phases.front().start(), .end = design_.phases.back().end(),
                     .directions = 0, .worst = 0.0, .mean = 0.0, .worst_direction = {}};
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
      if (k + 1 < phase.samples.size()) {
        transition = (transition * step_back(reduce(linear, weight_, aligned(Z, now_.Z, weight_)), phase.step())).eval();
      } else {
        transition = p + 1 < design_.phases.size() ? land(reduce(linear, weight_, Z)) : begin_at_end(reduce(linear, weight_, Z));
      }
      if (!S_.allFinite()) {
        throw NumericalError(fmt::format("no feedback gains in phase \"{}\" at t = {:.3f} s: the Riccati equation is not finite "
                                         "there", phase.name, point.time));
      }
      design_.gains[p][k] = control_weight_.asDiagonal() * now_.B.transpose() * S_ * now_.Z.transpose() * weight_.asDiagonal();
      if (on_sample_) on_sample_({static_cast<int>(p), static_cast<int>(k), now_.Z, now_.A, now_.B, S_});
    }
    design_.decay[p] = {.name = phase.name, .start = phase.start(), .end = phase.end(),
                        .directions = 0, .worst = 0.0, .mean = 0.0, .worst_direction = {}};
    fill_decay(robot_, transition, now_.Z, weight_, design_.decay[p]);
    whole_ = p + 1 < design_.phases.size() ? MatrixXd(whole_ * transition) : transition;
    if (p > 0) landing_ = linear.landing(weight_);
  }

  /// S at the end: of standing on for ever as at the end, or if that cannot be, for a second.
  MatrixXd begin_at_end(Reduced end) {
    now_ = std::move(end);
    const Eigen::Index n = now_.A.rows();
    RiccatiFlow flow = riccati_flow(now_.A, control_of(now_.B), MatrixXd::Identity(n, n), options_.step);
    const std::optional<MatrixXd> stationary = stationary_cost(flow);
    design_.stands_on = stationary.has_value();
    if (stationary) {
      S_ = *stationary;
      const Eigen::VectorXcd poles = (now_.A - control_of(now_.B) * S_).eigenvalues();
      design_.slowest_rate = poles.real().cwiseAbs().minCoeff();
      design_.fastest_rate = poles.cwiseAbs().maxCoeff();
    } else {
      for (double time = options_.step; time < 1.0; time *= 2.0) flow = compose(flow, flow);
      S_ = flow.cost;
    }
    return MatrixXd::Identity(n, n);
  }

  /// S before the switch to the phase after, whose first sample is at hand, and what the switch does to a deviation.
  MatrixXd land(Reduced before) {
    const MatrixXd landed = landing_ * before.Z;
    const MatrixXd jump = now_.Z.transpose() * weight_.asDiagonal() * landed;
    const Eigen::Index nv = robot_.nv();
    const MatrixXd lost = weight_.head(nv).cwiseSqrt().asDiagonal() * (before.Z - landed).topRows(nv);
    S_ = jump.transpose() * S_ * jump;
    S_ += options_.landing_time * lost.transpose() * lost;
    now_ = std::move(before);
    return jump;
  }

  MatrixXd step_back(Reduced left, double h) {
    const MatrixXd A = 0.5 * (left.A + now_.A), B = 0.5 * (left.B + now_.B);
    const Eigen::Index n = A.rows();
    const RiccatiFlow flow = riccati_flow(A, control_of(B), MatrixXd::Identity(n, n), h);
    const MatrixXd transition = flow.closed_loop(S_);
    S_ = flow.back(S_);
    now_ = std::move(left);
    return transition;
  }

  MatrixXd control_of(const MatrixXd& B) const { return B * control_weight_.asDiagonal() * B.transpose(); }

  const RobotModel& robot_;
  const TrackingOptions& options_;
  FeedbackDesign& design_;
  const std::function<void(const ReducedSample&)>& on_sample_;
  VectorXd weight_, control_weight_;
  Reduced now_;       // at the sample that was done last
  MatrixXd S_;        // there
  MatrixXd landing_;  // at the first sample of the phase that was done last
  MatrixXd whole_;    // deviation at the first sample of that phase -> at the end
};

}  // namespace

FeedbackDesign design_feedback(const MotionProblem& problem, const Trajectory& trajectory, const TrackingOptions& options,
                               const std::function<void(const ReducedSample&)>& on_sample) {
  FeedbackDesign design;
  design.phases = reference_grid(problem, trajectory, options.step);
  BackwardPass(problem, options, design, on_sample).run();
  return design;
}

}  // namespace prowl

#include "prowl/transcription/deferred_correction.hpp"

#include <algorithm>
#include <map>

#include "prowl/dynamics/forward_dynamics.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/trajectory/hermite_interval.hpp"
#include "prowl/trajectory/state_scale.hpp"

namespace prowl {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

/// The accelerations that torques cause. Phases with the same contacts share one work space: a gait has few sets.
class TrueAccelerations {
 public:
  explicit TrueAccelerations(const MotionProblem& problem) {
    for (const Phase& phase : problem.phases) {
      const std::vector<int> held = contact_indices(phase.contacts);
      of_phase_.push_back(&of_contacts_.try_emplace(held, problem.robot, held, kContactRankThreshold).first->second);
    }
  }
  TrueAccelerations(const TrueAccelerations&) = delete;
  TrueAccelerations& operator=(const TrueAccelerations&) = delete;

  const VectorXd& at(const TrajectoryPoint& point) {
    ForwardDynamics& dynamics = *of_phase_[point.phase];
    dynamics.evaluate(point.q, point.v, point.tau);
    return dynamics.acceleration();
  }

 private:
  std::map<std::vector<int>, ForwardDynamics> of_contacts_;
  std::vector<ForwardDynamics*> of_phase_;
};

VectorXd simpson_less_trapezoid(double h, const VectorXd& left, const VectorXd& middle, const VectorXd& right) {
  return h / 3.0 * (2.0 * middle - left - right);
}

/// δ in R_1 = R_0 exp(h/2 ω_0) exp(δ) exp(h/2 ω_1), with R_1 by Simpson's rule for the rotation vector from R_0.
Vector3d turn_correction(const TrajectoryPoint& left, const TrajectoryPoint& middle, const TrajectoryPoint& right) {
  const double h = right.time - left.time;
  const Vector3d half = difference(left.q, middle.q).segment<3>(3), whole = difference(left.q, right.q).segment<3>(3);
  const Vector3d w0 = left.v.segment<3>(3), wc = middle.v.segment<3>(3), w1 = right.v.segment<3>(3);
  const Vector3d turn =
      h / 6.0 * (w0 + 4.0 * so3::right_jacobian_inverse(half) * wc + so3::right_jacobian_inverse(whole) * w1);
  return so3::log(so3::exp(-0.5 * h * w0) * so3::exp(turn) * so3::exp(-0.5 * h * w1));
}

/// The ends have their true accelerations.
VectorXd correction(const TrajectoryPoint& left, const TrajectoryPoint& right, TrueAccelerations& accelerations) {
  const double h = right.time - left.time;
  const TrajectoryPoint middle = hermite_point(left, right, nullptr, 0.5 * h);
  VectorXd result(2 * left.v.size());
  result << simpson_less_trapezoid(h, tangent_rate(left), tangent_rate(middle), tangent_rate(right)),
      simpson_less_trapezoid(h, left.a, accelerations.at(middle), right.a);
  result.segment<3>(3) = turn_correction(left, middle, right);
  return result;
}

}  // namespace

Corrections deferred_corrections(const DiscreteProblem& discrete, const Trajectory& motion) {
  TrueAccelerations accelerations(discrete.problem);
  std::vector<TrajectoryPoint> nodes = motion.nodes;
  // Between the nodes of a coarser mesh, `a` is the slope of a cubic: its error would be one of first order here.
  for (TrajectoryPoint& node : nodes) node.a = accelerations.at(node);
  Corrections corrections(nodes.size());
  for (int k = 0; k + 1 < discrete.num_nodes(); ++k) {
    if (discrete.is_interval(k)) corrections[k + 1] = correction(nodes[k], nodes[k + 1], accelerations);
  }
  return corrections;
}

// The residual of the cubics vanishes at the ends. A change of the right node by d changes it by 6 u (1 - u) d / h at
// u = s / h: the change that removes it in the middle removes 3/4 of that at the quarters. What is left is a cubic
// through the ends and the middle, whose mean is 2/3 of its value at the quarters.
std::vector<StepError> step_errors(const MotionProblem& problem, const Trajectory& motion) {
  TrueAccelerations accelerations(problem);
  const VectorXd scale = state_scale(motion);
  std::vector<StepError> errors;
  for (std::size_t k = 0; k + 1 < motion.nodes.size(); ++k) {
    const TrajectoryPoint &left = motion.nodes[k], &right = motion.nodes[k + 1];
    if (left.phase != right.phase) continue;
    const double h = right.time - left.time;
    const auto residual = [&](double u) {
      const TrajectoryPoint point = hermite_point(left, right, nullptr, u * h);
      VectorXd rates(scale.size());
      rates << hermite_rate(left, right, u * h) - tangent_rate(point), point.a - accelerations.at(point);
      return VectorXd(2.0 / 3.0 * h * rates.cwiseQuotient(scale));
    };
    const VectorXd middle = residual(0.5);
    const auto left_over = [&](double u) { return (residual(u) - 0.75 * middle).cwiseAbs().maxCoeff(); };
    errors.push_back({middle.cwiseAbs().maxCoeff(), std::max(left_over(0.25), left_over(0.75))});
  }
  return errors;
}

}  // namespace prowl

#include "prowl/robust/tube.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/friction_limit.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Standard deviations that count: two, 95 % of a normal distribution.
constexpr double kCoverage = 2.0;
/// Of a value that is drawn evenly between minus and plus one.
const double kEven = 1.0 / std::sqrt(3.0);
constexpr double kPushEvery = 0.05;  // [s]; pushes begin at these times
constexpr double kForgotten = 1.5;   // [s] after it began, a push has no effect
/// The load of a contact grows from zero when it lands and goes to zero before it opens, and what is kept of its cone
/// with it: too short to slip far [s].
constexpr double kLoading = 0.1;
constexpr int kDirections = 8;  // around the axis of a friction cone

/// Euclidean lengths of the rows.
VectorXd lengths(const MatrixXd& rows) { return rows.rowwise().norm(); }

bool holds(const MotionProblem& problem, std::size_t phase, int contact) {
  return std::ranges::count(problem.phases[phase].contacts, contact, &PhaseContact::contact) > 0;
}

/// What is kept of its cone while a contact loads and unloads, 0 to 1. Times of the phases: tube.phases[p].times.
void fade(const MotionProblem& problem, Tube& tube) {
  for (std::size_t p = 0; p < tube.phases.size(); ++p) {
    Tube::OfPhase& phase = tube.phases[p];
    for (Eigen::Index i = 0; i < phase.needed.cone.rows(); ++i) {
      const int contact = problem.phases[p].contacts[static_cast<std::size_t>(i)].contact;
      std::size_t first = p, last = p;
      while (first > 0 && holds(problem, first - 1, contact)) --first;
      while (last + 1 < tube.phases.size() && holds(problem, last + 1, contact)) ++last;
      for (Eigen::Index k = 0; k < phase.needed.cone.cols(); ++k) {
        const double time = phase.times[static_cast<std::size_t>(k)];
        double& cone = phase.needed.cone(i, k);
        if (first > 0) cone *= std::min(1.0, (time - tube.phases[first].times.front()) / kLoading);
        if (last + 1 < tube.phases.size()) cone *= std::min(1.0, (tube.phases[last].times.back() - time) / kLoading);
      }
    }
  }
}

/// Slopes of the friction cone in its force, towards directions all around: the force may be anywhere near its axis,
/// where its own direction says nothing (kDirections x 3).
Eigen::Matrix<double, kDirections, 3> friction_slopes(const Surface& surface) {
  const Eigen::Matrix<double, 3, 2> along = surface.axes();
  Eigen::Matrix<double, kDirections, 3> slopes;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kDirections;
    slopes.row(i) = surface.friction * surface.normal - along * Eigen::Vector2d(std::cos(angle), std::sin(angle));
  }
  return slopes;
}

struct Push {
  double begin;
  MatrixXd deviation;  ///< xi, one column for each direction
};

}  // namespace

TubeDesign::TubeDesign(const MotionProblem& problem, const TrackingOptions& tracking, const Disturbances& disturbances)
    : problem_(problem),
      weight_(tracking.state_weight()),
      disturbances_(disturbances),
      inertia_(problem.robot),
      samples_(problem.phases.size()) {}

MatrixXd TubeDesign::start_deviations(const ReducedSample& first) const {
  const Eigen::Index nv = problem_.robot.nv(), nu = problem_.robot.nu();
  MatrixXd base = MatrixXd::Zero(2 * nv, 12);
  const double sizes[] = {disturbances_.base_position, disturbances_.base_angle, disturbances_.base_velocity,
                          disturbances_.base_rate};
  for (Eigen::Index i = 0; i < 12; ++i) base((i < 6 ? 0 : nv) + i % 6, i) = kEven * sizes[i / 3];
  // Legs follow: the feet stay.
  const MatrixXd& C = first.linear.C();
  MatrixXd by_joints(C.rows(), 2 * nu);
  by_joints << C.middleCols(6, nu), C.rightCols(nu);
  const MatrixXd joints = by_joints.completeOrthogonalDecomposition().solve(-C * base);
  base.middleRows(6, nu) += joints.topRows(nu);
  base.bottomRows(nu) += joints.bottomRows(nu);
  return first.Z.transpose() * weight_.asDiagonal() * base;
}

void TubeDesign::add(const ReducedSample& at) {
  if (at.phase >= static_cast<int>(samples_.size())) return;  // stands after the end
  const Eigen::Index nv = problem_.robot.nv(), nu = problem_.robot.nu();
  const auto phase = static_cast<std::size_t>(at.phase);
  const ForwardDynamics& dynamics = at.linear.dynamics();
  const ForwardDynamics::Derivatives& df = dynamics.force_derivatives();
  const MatrixXd torques = -at.K * at.Z;
  MatrixXd forces(df.q.rows(), at.Z.cols());
  forces = df.q * at.Z.topRows(nv) + df.v * at.Z.bottomRows(nv) + df.tau * torques;

  const MatrixXd applied = -inertia_.forces(at.point.q, at.point.v, dynamics.acceleration(), kEven * disturbances_.mass,
                                            kEven * disturbances_.center);
  MatrixXd pushed = MatrixXd::Zero(nv, 2);
  const double force = problem_.robot.mass() * disturbances_.push / disturbances_.push_duration;
  pushed.topRows<3>() = force * base_rotation(at.point.q).transpose().leftCols<2>();
  const MatrixXd left = (at.Z.transpose() * weight_.asDiagonal()).rightCols(nv) * dynamics.acceleration_by_force();
  const MatrixXd by_force = dynamics.forces_by_force();

  const auto& held = problem_.phases[phase].contacts;
  const auto cones = kDirections * static_cast<Eigen::Index>(held.size()), rows = cones + 2 * nu;
  Sample sample{.time = at.point.time,
                .Z = at.Z,
                .step = at.step,
                .drift = left * applied,
                .push = left * pushed,
                .limits = MatrixXd(rows, at.Z.cols()),
                .by_constants = MatrixXd::Zero(rows, applied.cols()),
                .by_push = MatrixXd::Zero(rows, 2)};
  sample.cone.resize(static_cast<Eigen::Index>(held.size()));
  sample.load = sample.cone;
  const RobotModel& robot = problem_.robot;
  sample.torque = robot.torque_limit() - at.point.tau.cwiseAbs();
  for (const RobotModel::TorqueCurve& limit : robot.torque_curves()) {
    const double tau = at.point.tau(limit.joint), velocity = at.point.v(6 + limit.joint);
    const double position = at.point.q(7 + limit.joint);
    const double upper = limit.curve.value(limit.over_velocity ? velocity : position);
    const double lower = limit.curve.value(limit.over_velocity ? -velocity : position);
    sample.torque(limit.joint) = std::min({sample.torque(limit.joint), upper - tau, lower + tau});
  }
  const VectorXd joints = at.point.q.tail(nu);
  sample.joint = (robot.position_upper() - joints).cwiseMin(joints - robot.position_lower());
  for (std::size_t i = 0; i < held.size(); ++i) {
    const auto at_contact = static_cast<Eigen::Index>(3 * i), row = static_cast<Eigen::Index>(i) * kDirections;
    const Eigen::Vector3d force_here = dynamics.forces().segment<3>(at_contact);
    const Surface& surface = problem_.surfaces[static_cast<std::size_t>(held[i].surface)];
    sample.load(static_cast<Eigen::Index>(i)) = surface.normal.dot(force_here);
    sample.cone(static_cast<Eigen::Index>(i)) =
        FrictionLimit(problem_.friction_model, surface, 1e-6 * robot.weight()).rows(force_here).minCoeff();
    const auto slopes = friction_slopes(surface);
    sample.limits.middleRows<kDirections>(row) = slopes * forces.middleRows<3>(at_contact);
    sample.by_constants.middleRows<kDirections>(row) = slopes * by_force.middleRows<3>(at_contact) * applied;
    sample.by_push.middleRows<kDirections>(row) = slopes * by_force.middleRows<3>(at_contact) * pushed;
  }
  sample.limits.middleRows(cones, nu) = torques;
  sample.limits.bottomRows(nu) = at.Z.middleRows(6, nu);
  samples_[phase].push_back(std::move(sample));
  if (at.phase == 0 && at.sample == 0) start_ = start_deviations(at);
}

Tube TubeDesign::propagate() const {
  Tube tube;
  MatrixXd start = start_, constants = MatrixXd::Zero(start_.rows(), inertia_.count());
  std::vector<Push> pushes;
  double next_push = 0.0;
  const Eigen::Index nu = problem_.robot.nu(), nv = problem_.robot.nv();
  for (std::size_t p = 0; p < samples_.size(); ++p) {
    const std::vector<Sample>& backwards = samples_[p];
    const auto& held = problem_.phases[p].contacts;
    const auto count = static_cast<Eigen::Index>(backwards.size()), contacts = static_cast<Eigen::Index>(held.size());
    Tube::OfPhase& phase = tube.phases.emplace_back();
    phase.state.resize(2 * nv, count);
    phase.pushed.setZero(2 * nv, count);
    phase.needed = phase.left = {MatrixXd(contacts, count), MatrixXd(nu, count), MatrixXd(nu, count)};
    phase.load.resize(contacts, count);
    for (Eigen::Index k = 0; k < count; ++k) {
      const Sample& at = backwards[static_cast<std::size_t>(count - 1 - k)];
      phase.times.push_back(at.time);
      if (at.time >= next_push) {
        pushes.push_back({at.time, MatrixXd::Zero(at.Z.cols(), 2)});
        next_push += kPushEvery;
      }
      std::erase_if(pushes, [&](const Push& push) { return at.time - push.begin > kForgotten; });

      MatrixXd drawn(at.Z.cols(), start.cols() + constants.cols());
      drawn << start, constants;
      MatrixXd of_limits = at.limits * drawn;
      of_limits.rightCols(constants.cols()) += at.by_constants;
      VectorXd worst = VectorXd::Zero(at.limits.rows());
      for (const Push& push : pushes) {
        MatrixXd effect = at.limits * push.deviation;
        if (at.time < push.begin + disturbances_.push_duration) effect += at.by_push;
        worst = worst.cwiseMax(lengths(effect));
        phase.pushed.col(k) = phase.pushed.col(k).cwiseMax(lengths(at.Z * push.deviation));
      }
      phase.state.col(k) = lengths(at.Z * drawn);
      const VectorXd needed =
          (kCoverage * kCoverage * lengths(of_limits).array().square() + worst.array().square()).sqrt();
      const Eigen::Index cones = needed.size() - 2 * nu;
      for (Eigen::Index i = 0; i < contacts; ++i)
        phase.needed.cone(i, k) = needed.segment<kDirections>(i * kDirections).maxCoeff();
      phase.needed.torque.col(k) = needed.segment(cones, nu);
      phase.needed.joint.col(k) = needed.tail(nu);
      phase.left.cone.col(k) = at.cone;
      phase.left.torque.col(k) = at.torque;
      phase.left.joint.col(k) = at.joint;
      phase.load.col(k) = at.load;

      if (k + 1 < count) {
        const Sample& after = backwards[static_cast<std::size_t>(count - 2 - k)];
        const double h = after.time - at.time;
        constants = at.step * constants + 0.5 * h * (at.step * at.drift + after.drift);
        for (Push& push : pushes) {
          push.deviation = at.step * push.deviation;
          if (at.time < push.begin + disturbances_.push_duration)
            push.deviation += 0.5 * h * (at.step * at.push + after.push);
        }
      } else {
        constants = at.step * constants;
        for (Push& push : pushes) push.deviation = at.step * push.deviation;
      }
      start = at.step * start;
    }
  }
  fade(problem_, tube);
  return tube;
}

}  // namespace prowl

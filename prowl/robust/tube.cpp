#include "prowl/robust/tube.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "prowl/linear_algebra/factorisations.hpp"
#include "prowl/model/all_contacts.hpp"
#include "prowl/model/body_tree.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/so3.hpp"
#include "prowl/motion/friction_limit.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Standard deviations that count: two, 95 % of a normal distribution.
constexpr double kCoverage = 2.0;
/// Of a value that is drawn evenly between minus and plus one.
const double kEven = 1.0 / std::sqrt(3.0);
constexpr int kEstimates = 6;        // errors of the estimate: base position and angle, each axis
constexpr double kPushEvery = 0.05;  // [s]; pushes begin at these times
constexpr double kForgotten = 1.5;   // [s] after it began, a push has no effect
/// The load of a contact grows from zero when it lands and goes to zero before it opens, and what is kept of its cone
/// with it: too short to slip far [s].
constexpr double kLoading = 0.1;
/// Before it lands and after it opens a contact is low: so long may it land early, as prowl/simulation/judge.hpp says
/// [s], and share of the swing.
constexpr double kLow = 0.1, kLowShare = 0.25;
constexpr double kSharp = 1e-6;  // tip of the cone that measures what is left, over the weight
constexpr int kDirections = 8;   // around the axis of a friction cone

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

/// Time at which each phase begins, and the end [s].
std::vector<double> times_of(const MotionProblem& problem, const Trajectory& motion) {
  std::vector<double> times(problem.phases.size() + 1, motion.nodes.back().time);
  for (auto node = motion.nodes.rbegin(); node != motion.nodes.rend(); ++node) times[node->phase] = node->time;
  return times;
}

/// What a contact keeps of its clearance at this time of its swing, 0 to 1.
double kept_clearance(const ContactSwing& swing, const std::pair<double, double>& times, double time) {
  const double low = std::min(kLow, kLowShare * (times.second - times.first));
  double part = 1.0;
  if (swing.before >= 0) part = std::min(part, (time - times.first) / low);
  if (swing.after >= 0) part = std::min(part, (times.second - time) / low);
  part = std::max(part, 0.0);
  return part * part;  // contacts leave and land at rest
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

}  // namespace

MatrixXd Tube::OfPhase::band() const { return kCoverage * state; }

Tube make_tube(const MotionProblem& problem, const Trajectory& motion, const TrackingOptions& tracking,
               const Disturbances& disturbances, double step) {
  TrackingOptions coarse = tracking;
  coarse.step = step;
  TubeDesign design(problem, motion, coarse, disturbances);
  design_feedback(problem, motion, coarse, [&](const ReducedSample& sample) { design.add(sample); });
  return design.propagate();
}

MatrixXd rows_of_contacts(const MotionProblem& problem, std::size_t phase, const MatrixXd& held) {
  const auto contacts = static_cast<Eigen::Index>(problem.robot.contacts().size());
  MatrixXd all = MatrixXd::Constant(contacts, held.cols(), std::numeric_limits<double>::quiet_NaN());
  for (Eigen::Index i = 0; i < held.rows(); ++i)
    all.row(problem.phases[phase].contacts[static_cast<std::size_t>(i)].contact) = held.row(i);
  return all;
}

TubeDesign::TubeDesign(const MotionProblem& problem, const Trajectory& motion, const TrackingOptions& tracking,
                       const Disturbances& disturbances)
    : problem_(problem),
      end_(motion.nodes.back().time),
      weight_(tracking.state_weight()),
      disturbances_(disturbances),
      inertia_(problem.robot),
      pushed_at_(body_tree(problem.robot).bodies.front().center),
      schedule_(problem),
      terms_(problem.robot),
      feet_(all_contacts(problem.robot)),
      is_footed_(problem.robot.contacts().size(), false),
      samples_(problem.phases.size()) {
  const std::vector<double> times = times_of(problem, motion);
  for (const Phase& phase : problem.phases) {
    for (const PhaseContact& held : phase.contacts) is_footed_[static_cast<std::size_t>(held.contact)] = true;
  }
  for (const ContactSwing& swing : schedule_.swings())
    swings_.emplace_back(times[swing.first_phase], times[swing.last_phase + 1]);
}

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
  const MatrixXd forces = df.q * at.Z.topRows(nv) + df.v * at.Z.bottomRows(nv) + df.tau * torques;

  const auto masses = static_cast<Eigen::Index>(inertia_.count()), constants = masses + kEstimates;
  MatrixXd applied = MatrixXd::Zero(nv, masses + 2);  // errors of masses, then the push
  applied.leftCols(masses) = -inertia_.forces(at.point.q, at.point.v, dynamics.acceleration(),
                                              kEven * disturbances_.mass, kEven * disturbances_.center);
  const double push = problem_.robot.mass() * disturbances_.push / disturbances_.push_duration;  // [N]
  const Eigen::Matrix<double, 3, 2> forces_of_push = push * base_rotation(at.point.q).transpose().leftCols<2>();
  applied.topRightCorner<3, 2>() = forces_of_push;
  applied.block<3, 2>(3, masses) = so3::skew(pushed_at_) * forces_of_push;
  const auto [accelerations, contact_forces] = dynamics.response(applied);
  const MatrixXd rates = (at.Z.transpose() * weight_.asDiagonal()).rightCols(nv) * accelerations;
  terms_.update_kinematics(at.point.q);
  feet_.set_configuration(terms_);
  const MatrixXd by_height = joints_by_height();
  const MatrixXd misled = misled_torques(at, by_height);
  MatrixXd drift(at.Z.cols(), constants);
  drift << rates.leftCols(masses), at.B * misled;

  const auto& held = problem_.phases[phase].contacts;
  const auto contacts = static_cast<Eigen::Index>(held.size()), cones = kDirections * contacts;
  const Eigen::Index feet = feet_.rows() / 3, rows = cones + 2 * nu + feet;
  Sample sample{.time = at.point.time,
                .Z = at.Z,
                .step = at.step,
                .drift = std::move(drift),
                .push = rates.rightCols(2),
                .limits = MatrixXd(rows, at.Z.cols()),
                .by_constants = MatrixXd::Zero(rows, constants),
                .by_push = MatrixXd::Zero(rows, 2),
                .by_ground = disturbances_.ground / kCoverage * by_height,
                .friction = VectorXd(contacts),
                .cone_left = VectorXd(contacts),
                .torque_left = VectorXd(nu),
                .height = VectorXd::Constant(feet, std::numeric_limits<double>::infinity())};
  const RobotModel& robot = problem_.robot;
  for (int j = 0; j < robot.nu(); ++j) {
    const double position = at.point.q(7 + j), rate = at.point.v(6 + j);
    const double tau = at.point.tau(j) + robot.losses().torque(j, rate);
    sample.torque_left(j) =
        std::min(robot.torque_upper(j, position, rate) - tau, tau - robot.torque_lower(j, position, rate));
  }
  for (Eigen::Index i = 0; i < contacts; ++i) {
    const auto& surface = problem_.surfaces[static_cast<std::size_t>(held[static_cast<std::size_t>(i)].surface)];
    // The motion's: those of the dynamics are the least that redundant contacts need.
    const Eigen::Vector3d force = at.point.force.segment<3>(3 * held[static_cast<std::size_t>(i)].contact);
    Surface slippery = surface;
    slippery.friction *= 1.0 - disturbances_.friction;
    const auto left = [&](const Surface& on) {
      return FrictionLimit(problem_.friction_model, on, kSharp * robot.weight()).rows(force).minCoeff();
    };
    sample.cone_left(i) = left(surface);
    sample.friction(i) = std::max(sample.cone_left(i) - left(slippery), 0.0);
    const auto slopes = friction_slopes(surface);
    const MatrixXd by_force = slopes * contact_forces.middleRows<3>(3 * i);
    sample.limits.middleRows<kDirections>(kDirections * i) = slopes * forces.middleRows<3>(3 * i);
    sample.by_constants.middleRows<kDirections>(kDirections * i) << by_force.leftCols(masses),
        slopes * df.tau.middleRows<3>(3 * i) * misled;
    sample.by_push.middleRows<kDirections>(kDirections * i) = by_force.rightCols(2);
  }
  sample.limits.middleRows(cones, nu) = torques;
  sample.by_constants.middleRows(cones, nu).rightCols<kEstimates>() = misled;
  sample.limits.middleRows(cones + nu, nu) = at.Z.middleRows(6, nu);
  add_heights(at, sample);
  samples_[phase].push_back(std::move(sample));
  if (at.phase == 0 && at.sample == 0) start_ = start_deviations(at);
}

/// Of the contacts in the air, at the configuration of feet_.
void TubeDesign::add_heights(const ReducedSample& at, Sample& sample) {
  auto rows = sample.limits.bottomRows(feet_.rows() / 3);
  rows.setZero();
  for (std::size_t i = 0; i < swings_.size(); ++i) {
    const ContactSwing& swing = schedule_.swings()[i];
    if (at.phase < swing.first_phase || at.phase > swing.last_phase) continue;
    const double progress = (at.point.time - swings_[i].first) / (swings_[i].second - swings_[i].first);
    for (int s = 0; s < static_cast<int>(problem_.surfaces.size()); ++s) {
      const Surface& surface = problem_.surfaces[s];
      if (!schedule_.passes(problem_, swing, s, progress)) continue;
      const double height = surface.distance(feet_.positions().segment<3>(3 * swing.contact)) -
                            problem_.robot.contacts()[swing.contact].radius;
      if (height >= sample.height(swing.contact)) continue;
      sample.height(swing.contact) = height;
      rows.row(swing.contact) = surface.normal.transpose() * feet_.positions_dq().middleRows<3>(3 * swing.contact) *
                                at.Z.topRows(problem_.robot.nv());
    }
  }
}

/// The base stays, each footed contact goes up by 1 m: as GroundEstimator lays the plan on the ground.
MatrixXd TubeDesign::joints_by_height() const {
  const Eigen::Index nu = problem_.robot.nu();
  MatrixXd by_joints = feet_.positions_dq().rightCols(nu);
  for (Eigen::Index c = 0; c < feet_.rows() / 3; ++c) {
    if (!is_footed_[static_cast<std::size_t>(c)]) by_joints.middleRows<3>(3 * c).setZero();
  }
  MatrixXd up = MatrixXd::Zero(feet_.rows(), feet_.rows() / 3);
  for (Eigen::Index c = 0; c < up.cols(); ++c) up(3 * c + 2, c) = 1.0;
  return damped_solution(by_joints, up);
}

/// Torques of the feedback that takes an error of the estimated base, each axis of its position and angle, for a
/// deviation. The feet seem to be higher by it, too, as the ground estimator believes.
MatrixXd TubeDesign::misled_torques(const ReducedSample& at, const MatrixXd& by_height) const {
  Eigen::Matrix<double, kEstimates, kEstimates> base = Eigen::Matrix<double, kEstimates, kEstimates>::Zero();
  base.diagonal() << Eigen::Vector3d::Constant(kEven * disturbances_.estimate_position),
      Eigen::Vector3d::Constant(kEven * disturbances_.estimate_angle);
  const Eigen::Matrix3d R = base_rotation(at.point.q);
  MatrixXd heights(feet_.rows() / 3, kEstimates);
  for (Eigen::Index c = 0; c < heights.rows(); ++c) {
    const Eigen::Vector3d lever = feet_.positions().segment<3>(3 * c) - base_position(at.point.q);
    heights.row(c) = base.row(2) - (so3::skew(lever) * R).row(2) * base.bottomRows<3>();
  }
  MatrixXd error = MatrixXd::Zero(2 * problem_.robot.nv(), kEstimates);
  error.topRows<kEstimates>() = base;
  error.middleRows(kEstimates, problem_.robot.nu()) = -by_height * heights;
  return -at.K * error;
}

void TubeDesign::Deviations::advance(const Sample& at, const Sample* after, double push_duration) {
  start = at.step * start;
  constants = at.step * constants;
  for (Push& push : pushes) push.deviation = at.step * push.deviation;
  if (!after) return;  // a landing takes no time
  const double h = after->time - at.time;
  constants += 0.5 * h * (at.step * at.drift + after->drift);
  for (Push& push : pushes) {
    const double pushed = std::clamp(push.begin + push_duration - at.time, 0.0, h);  // part of the step
    push.deviation += 0.5 * pushed * (at.step * at.push + after->push);
  }
}

/// Fills column k of the phase.
void TubeDesign::measure(const Sample& at, const Deviations& deviations, Tube::OfPhase& phase, Eigen::Index k) const {
  MatrixXd drawn(at.Z.cols(), deviations.start.cols() + deviations.constants.cols());
  drawn << deviations.start, deviations.constants;
  MatrixXd of_limits = at.limits * drawn;
  of_limits.rightCols(deviations.constants.cols()) += at.by_constants;
  VectorXd worst = VectorXd::Zero(at.limits.rows());
  VectorXd pushed = VectorXd::Zero(at.Z.rows());  // squares
  const double likely = 0.5 * kPushEvery / end_;  // that it begins then, and points along one of two axes
  for (const Push& push : deviations.pushes) {
    MatrixXd effect = at.limits * push.deviation;
    if (at.time < push.begin + disturbances_.push_duration) effect += at.by_push;
    worst = worst.cwiseMax(lengths(effect));
    pushed += likely * (at.Z * push.deviation).rowwise().squaredNorm();
  }
  const Eigen::Index nu = at.torque_left.size();
  const VectorXd by_ground = lengths(at.by_ground);
  VectorXd spread = lengths(of_limits);  // standard deviations
  auto joints = spread.segment(kDirections * at.cone_left.size() + nu, nu);
  joints = (joints.array().square() + by_ground.array().square()).sqrt();
  VectorXd squares = (at.Z * drawn).rowwise().squaredNorm() + pushed;
  squares.segment(6, nu) += by_ground.cwiseAbs2();
  phase.state.col(k) = squares.cwiseSqrt();
  const VectorXd needed = (kCoverage * kCoverage * spread.array().square() + worst.array().square()).sqrt();
  const Eigen::Index contacts = at.cone_left.size();
  for (Eigen::Index i = 0; i < contacts; ++i)
    phase.needed.cone(i, k) = needed.segment<kDirections>(i * kDirections).maxCoeff();
  phase.needed.torque.col(k) = needed.segment(kDirections * contacts, nu);
  phase.needed.joint.col(k) = needed.segment(kDirections * contacts + nu, nu);
  const auto rise = needed.tail(at.height.size()).array().square() + disturbances_.ground * disturbances_.ground;
  phase.needed.clearance.col(k).setZero();
  for (std::size_t i = 0; i < swings_.size(); ++i) {
    const ContactSwing& swing = schedule_.swings()[i];
    if (at.time < swings_[i].first || at.time > swings_[i].second) continue;
    if (!std::isfinite(at.height(swing.contact))) continue;  // held: the phase before or after
    phase.needed.clearance(swing.contact, k) =
        kept_clearance(swing, swings_[i], at.time) * std::sqrt(rise(swing.contact));
  }
  phase.height.col(k) = at.height;
  phase.friction.col(k) = at.friction;
  phase.cone_left.col(k) = at.cone_left;
  phase.torque_left.col(k) = at.torque_left;
}

Tube TubeDesign::propagate() const {
  Tube tube;
  Deviations deviations{start_, MatrixXd::Zero(start_.rows(), inertia_.count() + kEstimates), {}};
  double next_push = 0.0;
  const Eigen::Index nu = problem_.robot.nu(), nv = problem_.robot.nv();
  for (const std::vector<Sample>& backwards : samples_) {
    const auto count = static_cast<Eigen::Index>(backwards.size()), contacts = backwards.front().cone_left.size();
    Tube::OfPhase& phase = tube.phases.emplace_back();
    phase.state.resize(2 * nv, count);
    phase.needed = {MatrixXd(contacts, count), MatrixXd(nu, count), MatrixXd(nu, count),
                    MatrixXd(feet_.rows() / 3, count)};
    phase.height.resize(feet_.rows() / 3, count);
    phase.friction.resize(contacts, count);
    phase.cone_left.resize(contacts, count);
    phase.torque_left.resize(nu, count);
    for (auto at = backwards.rbegin(); at != backwards.rend(); ++at) {
      if (at->time >= next_push) {
        deviations.pushes.push_back({at->time, MatrixXd::Zero(at->Z.cols(), 2)});
        next_push += kPushEvery;
      }
      std::erase_if(deviations.pushes, [&](const Push& push) { return at->time - push.begin > kForgotten; });
      measure(*at, deviations, phase, static_cast<Eigen::Index>(phase.times.size()));
      phase.times.push_back(at->time);
      const bool is_last = std::next(at) == backwards.rend();
      deviations.advance(*at, is_last ? nullptr : &*std::next(at), disturbances_.push_duration);
    }
  }
  fade(problem_, tube);
  return tube;
}

}  // namespace prowl

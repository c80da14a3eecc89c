#include "prowl/tracker/tracker.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>

namespace prowl {
namespace {

/// On the stack: the control loop does not allocate.
using Tangent = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Tracker::kMostVelocities, 1>;
using State = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 2 * Tracker::kMostVelocities, 1>;
using Configuration = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, Tracker::kMostVelocities + 1, 1>;

/// Rotation vector of a unit quaternion, at most pi long [rad].
Eigen::Vector3d rotation_vector(const Eigen::Quaterniond& turn) {
  const double sine = turn.vec().norm();  // of half the angle
  const double sign = turn.w() < 0.0 ? -1.0 : 1.0;
  constexpr double kSmall = 1e-8;  // below it angle / sine is 2 within rounding
  const double scale = sine < kSmall ? 2.0 : 2.0 * std::atan2(sine, std::abs(turn.w())) / sine;
  return sign * scale * turn.vec();
}

template <class Q>
Eigen::Quaterniond quaternion(const Q& q) {
  return Eigen::Quaterniond(q(6), q(3), q(4), q(5)).normalized();
}

double value(const TrackingPlan::TorqueCurve& curve, double x) {
  const auto last = static_cast<double>(curve.values.size() - 1);
  const double position = std::clamp((x - curve.lower) / (curve.upper - curve.lower) * last, 0.0, last);
  const auto i = std::min(static_cast<Eigen::Index>(position), curve.values.size() - 2);
  const double share = position - static_cast<double>(i);
  return (1.0 - share) * curve.values(i) + share * curve.values(i + 1);
}

}  // namespace

void configuration_difference(const Tracker::ConstVector& q, const Tracker::ConstVector& q_to,
                              Tracker::Vector tangent) noexcept {
  tangent.head<3>() = q_to.head<3>() - q.head<3>();
  tangent.segment<3>(3) = rotation_vector(quaternion(q).conjugate() * quaternion(q_to));
  tangent.tail(q.size() - 7) = q_to.tail(q.size() - 7) - q.tail(q.size() - 7);
}

const TrackingPlan::Segment& Tracker::segment(double t) const noexcept {
  for (const TrackingPlan::Segment& segment : plan_.segments) {
    if (t < segment.end) return segment;
  }
  return plan_.segments.back();
}

Tracker::Bracket Tracker::find(double t) const noexcept {
  const TrackingPlan::Segment& at = segment(t);
  const double intervals = at.samples - 1;
  double position = (t - at.start) / (at.end - at.start) * intervals;
  if (!(position < intervals)) position = intervals;  // also NaN
  position = std::max(position, 0.0);
  const int i = std::min(static_cast<int>(position), at.samples - 2);
  return {at.first_sample + i, at.first_sample + i + 1, position - i};
}

Eigen::Map<const Eigen::MatrixXd> Tracker::gain(Eigen::Index sample) const noexcept {
  return {plan_.gains.col(sample).data(), plan_.nu(), 2 * plan_.nv()};
}

void Tracker::reference(double t, Vector q, Vector v) const noexcept {
  assert(q.size() == plan_.nq() && v.size() == plan_.nv());
  const Bracket bracket = find(t);
  q = between(bracket, plan_.q);
  v = between(bracket, plan_.v);
  q.segment<4>(3) =
      quaternion(plan_.q.col(bracket.first)).slerp(bracket.share, quaternion(plan_.q.col(bracket.second))).coeffs();
}

void Tracker::gains(double t, Eigen::Ref<Eigen::MatrixXd> K) const noexcept {
  const auto [first, second, share] = find(t);
  K = (1.0 - share) * gain(first) + share * gain(second);
}

void Tracker::feedforward(double t, Vector tau) const noexcept { tau = between(find(t), plan_.tau); }

void Tracker::feedback(double t, const ConstVector& q, const ConstVector& v, Vector tau) const noexcept {
  assert(q.size() == plan_.nq() && v.size() == plan_.nv() && tau.size() == plan_.nu());
  tau.setZero();
  if (!q.allFinite() || !v.allFinite() || q.segment<4>(3).isZero(0.0)) return;

  Configuration q_reference(plan_.nq());
  Tangent v_reference(plan_.nv());
  reference(t, q_reference, v_reference);
  State error(2 * plan_.nv());
  configuration_difference(q, q_reference, error.head(plan_.nv()));
  error.tail(plan_.nv()) = v_reference - v;

  const auto [first, second, share] = find(t);
  tau.noalias() += (1.0 - share) * gain(first) * error;
  tau.noalias() += share * gain(second) * error;
}

void Tracker::limit(const ConstVector& q, const ConstVector& v, Vector tau) const noexcept {
  tau = tau.cwiseMax(-plan_.torque_limit).cwiseMin(plan_.torque_limit);
  if (!q.allFinite() || !v.allFinite()) return;
  for (const TrackingPlan::TorqueCurve& curve : plan_.torque_curves) {
    const double position = q(7 + curve.joint), velocity = v(6 + curve.joint);
    double& torque = tau(curve.joint);
    if (curve.torques != TrackingPlan::Torques::negative)
      torque = std::min(torque, value(curve, curve.over_velocity ? velocity : position));
    if (curve.torques != TrackingPlan::Torques::positive)
      torque = std::max(torque, -value(curve, curve.over_velocity ? -velocity : position));
  }
}

void Tracker::torque(double t, const ConstVector& q, const ConstVector& v, Vector tau) const noexcept {
  feedback(t, q, v, tau);
  if (!tau.allFinite()) tau.setZero();  // overflow for absurd states
  tau += between(find(t), plan_.tau);
  limit(q, v, tau);
}

}  // namespace prowl

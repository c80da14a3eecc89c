#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// A tracking plan, or the file of one, that makes no sense.
class TrackerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Torques that keep a robot on its plan. This folder needs Eigen and nothing else: it can be copied to a robot.
///
///   tau = tau*(t) + K(t) (x* ⊖ x),  within the torque limits
///
/// x* ⊖ x, 2 nv entries, is the way from the measured state x = (q, v) to the reference x*(t):
///   0-2    p* - p              displacement of the base, WORLD frame [m]
///   3-5    log(R' R*)          rotation vector in the frame of the measured base [rad], at most pi long
///   6...   joints* - joints    [rad, m]
///   nv...  v* - v              base twist, each in its own base frame [m/s, rad/s]; joint rates
///
/// The reference lies on the grid of the plan (2 ms unless asked otherwise): linear in between, orientations along the
/// shortest turn, K linear too. At a switch of contacts, the later phase. Before the start the first sample, after the
/// end the last: the robot goes on standing with its last gains. A time that is NaN counts as after the end.
///
/// Immutable; any number of threads may ask at once. No call but the constructor and read() allocates or throws.
class Tracker {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;
  using Vector = Eigen::Ref<Eigen::VectorXd>;

  static constexpr int kMostVelocities = 256;  ///< nv; work space of that size is on the stack

  /// Throws TrackerError, naming what is wrong, unless sizes and times are those of tracking_plan.hpp, numbers finite,
  /// quaternions of unit length.
  explicit Tracker(TrackingPlan plan);
  /// From the file that `prowl plan` writes, tracker.bin (docs/tracking.md). Throws TrackerError if it cannot be read,
  /// is no such file, is cut short, longer than it says, or changed.
  static Tracker read(const std::string& path);

  const TrackingPlan& plan() const noexcept { return plan_; }             ///< joint and contact names, schedule, limits
  double start() const noexcept { return plan_.segments.front().start; }  ///< [s]
  double end() const noexcept { return plan_.segments.back().end; }       ///< [s]

  /// tau (nu) for the measured state q (nq), v (nv) at time t [s]. With NaN or infinity in the state there is no
  /// feedback. The quaternion need not be of unit length.
  void torque(double t, const ConstVector& q, const ConstVector& v, Vector tau) const noexcept;

  void feedforward(double t, Vector tau) const noexcept;  ///< tau*(t), not limited
  /// K(t) (x* ⊖ x), not limited.
  void feedback(double t, const ConstVector& q, const ConstVector& v, Vector tau) const noexcept;
  void reference(double t, Vector q, Vector v) const noexcept;         ///< x*(t)
  void gains(double t, Eigen::Ref<Eigen::MatrixXd> K) const noexcept;  ///< K(t), nu x 2 nv
  /// Brings tau within what the joints can give at this state.
  void limit(const ConstVector& q, const ConstVector& v, Vector tau) const noexcept;

  /// Segment of the plan at time t: its contacts, its name.
  const TrackingPlan::Segment& segment(double t) const noexcept;

 private:
  /// Between two samples: (1 - share) first + share second.
  struct Place {
    Eigen::Index first, second;
    double share;
  };
  Place find(double t) const noexcept;
  /// An expression: no copy.
  static auto between(const Place& place, const Eigen::MatrixXd& samples) {
    return (1.0 - place.share) * samples.col(place.first) + place.share * samples.col(place.second);
  }
  Eigen::Map<const Eigen::MatrixXd> gain(Eigen::Index sample) const noexcept;

  TrackingPlan plan_;
};

/// The way from configuration q to q_to, as above: nv entries. Exactly minus the way back.
void configuration_difference(const Tracker::ConstVector& q, const Tracker::ConstVector& q_to,
                              Tracker::Vector tangent) noexcept;

}  // namespace prowl

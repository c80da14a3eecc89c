#pragma once

#include <Eigen/Core>
#include <stdexcept>
#include <string>

#include "prowl/tracker/tracking_plan.hpp"

namespace prowl {

/// An invalid tracking plan or tracker file.
class TrackerError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Control law that keeps a robot on its plan. This folder needs only Eigen and can be copied to a
/// robot.
///
///   tau = tau*(t) + K(t) (x* ⊖ x),  within the torque limits
///
/// x* ⊖ x (2 nv) is the difference from the measured state x = (q, v) to the reference x*(t):
///   0-2    p* - p              displacement of the base, WORLD frame [m]
///   3-5    log(R' R*)          rotation vector in the measured base frame [rad], at most pi long
///   6...   joints* - joints    [rad, m]
///   nv...  v* - v              base twist, each in its own base frame [m/s, rad/s]; joint rates
///
/// Reference and gains are interpolated linearly on the grid of the plan (2 ms by default),
/// orientations along the shortest rotation. At a phase transition the later phase counts. Before
/// the start the first sample holds, after the end (or at NaN) the last: the robot keeps standing
/// with the last gains.
///
/// Immutable, so thread-safe. Only the constructor and read() allocate or throw.
class Tracker {
 public:
  using ConstVector = Eigen::Ref<const Eigen::VectorXd>;
  using Vector = Eigen::Ref<Eigen::VectorXd>;

  static constexpr int kMostVelocities = 256;  ///< largest nv; sizes the work space on the stack

  /// Throws TrackerError with the reason unless sizes and times agree with tracking_plan.hpp,
  /// numbers are finite, and quaternions have unit length.
  explicit Tracker(TrackingPlan plan);
  /// Reads tracker.bin, written by `prowl plan` (docs/tracking.md). Throws TrackerError if it is
  /// unreadable, of another format, truncated, too long, or altered.
  static Tracker read(const std::string& path);

  const TrackingPlan& plan() const noexcept { return plan_; }             ///< joint and contact names, schedule, limits
  double start() const noexcept { return plan_.segments.front().start; }  ///< [s]
  double end() const noexcept { return plan_.segments.back().end; }       ///< [s]

  /// tau (nu) for the measured state q (nq), v (nv) at time t [s]. A state with NaN or infinity
  /// gives feedforward only. The quaternion need not have unit length.
  void torque(double t, const ConstVector& q, const ConstVector& v, Vector tau) const noexcept;

  void feedforward(double t, Vector tau) const noexcept;  ///< tau*(t), not limited
  /// K(t) (x* ⊖ x), not limited.
  void feedback(double t, const ConstVector& q, const ConstVector& v, Vector tau) const noexcept;
  void reference(double t, Vector q, Vector v) const noexcept;         ///< x*(t)
  void gains(double t, Eigen::Ref<Eigen::MatrixXd> K) const noexcept;  ///< K(t), nu x 2 nv
  /// Clamps tau to the torque limits at this state.
  void limit(const ConstVector& q, const ConstVector& v, Vector tau) const noexcept;

  /// Segment of the plan at time t [s].
  const TrackingPlan::Segment& segment(double t) const noexcept;

 private:
  /// Position between two samples: (1 - share) first + share second.
  struct Bracket {
    Eigen::Index first, second;
    double share;
  };
  Bracket find(double t) const noexcept;
  /// Returns an Eigen expression: no copy.
  static auto between(const Bracket& bracket, const Eigen::MatrixXd& samples) {
    return (1.0 - bracket.share) * samples.col(bracket.first) + bracket.share * samples.col(bracket.second);
  }
  Eigen::Map<const Eigen::MatrixXd> gain(Eigen::Index sample) const noexcept;

  TrackingPlan plan_;
};

/// Difference from q to q_to (nv entries), as above. Exactly antisymmetric.
void configuration_difference(const Tracker::ConstVector& q, const Tracker::ConstVector& q_to,
                              Tracker::Vector tangent) noexcept;

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace prowl {

/// Input of a tracker: reference, gains and contact schedule on a time grid. Plain data; Tracker
/// rejects other sizes than those below. nq = 7 + nu, nv = 6 + nu.
///
/// Configuration q = (base position in the world [m], base quaternion x y z w, joint positions [rad, m]).
/// Velocity v = (linear and angular velocity of the base in the base frame [m/s, rad/s], joint rates).
struct TrackingPlan {
  /// A time with one set of contacts, sampled at `samples` >= 2 equally spaced times from start to end.
  struct Segment {
    std::string name;
    double start = 0.0, end = 0.0;      ///< [s], start < end; each segment starts where the previous one ends
    int first_sample = 0, samples = 0;  ///< columns of the matrices below
    std::vector<bool> in_contact;       ///< per contact
  };

  enum class Torques { both, positive, negative };  ///< those that a curve limits

  /// A torque limit that depends on the state: tau <= value(position) and -tau <= value(position), or tau <=
  /// value(velocity) and -tau <= value(-velocity); or one of these. Linear between `values` at equally spaced arguments
  /// from lower to upper, constant beyond.
  struct TorqueCurve {
    int joint = 0;
    bool over_velocity = false;
    Torques torques = Torques::both;
    double lower = 0.0, upper = 0.0;  ///< [rad] or [rad/s]
    Eigen::VectorXd values;           ///< >= 0 [N m], two or more
  };

  std::vector<std::string> joint_names;  ///< nu, in the order of q, v and tau
  std::vector<std::string> contact_names;
  Eigen::VectorXd torque_limit;  ///< nu [N m]; +inf without limit
  std::vector<TorqueCurve> torque_curves;
  std::vector<Segment> segments;  ///< one or more, in order of time

  Eigen::MatrixXd q;      ///< nq x samples
  Eigen::MatrixXd v;      ///< nv x samples
  Eigen::MatrixXd tau;    ///< nu x samples [N m]
  Eigen::MatrixXd gains;  ///< 2 nu nv x samples: each column K (nu x 2 nv, column by column), see Tracker::torque

  int nu() const { return static_cast<int>(joint_names.size()); }
  int nv() const { return 6 + nu(); }
  int nq() const { return 7 + nu(); }
  int num_samples() const { return static_cast<int>(q.cols()); }
};

}  // namespace prowl

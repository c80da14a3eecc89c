#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "prowl/motion/phase.hpp"
#include "prowl/terms/term.hpp"

namespace prowl {

struct GoalTolerance;

/// A term in a motion: when it counts, and as a limit or as a cost.
///
///   limit   lower <= f <= upper, -inf and +inf where free. Equal bounds are exact at one moment; over a span bounds
///   are
///           at least the tolerance of the certificate apart, so that torques stay smooth.
///   cost    1/2 sum_i weight_i (f_i - reference_i)^2, integrated over the span, or at the moment
///
/// Nodes of the mesh keep the limit; the certificate checks it between them, too.
struct TermUse {
  std::string name;                             ///< unique in the motion
  std::shared_ptr<const Term> term;             ///< shared by the copies of a problem
  PhaseFraction from = {}, to = {};             ///< first and last moment, both at nodes; equal for one moment
  Eigen::VectorXd lower, upper;                 ///< one entry for each row, in the term's unit; empty for a cost
  Eigen::VectorXd weight = {}, reference = {};  ///< likewise, weights >= 0; empty for a limit

  bool is_cost() const { return weight.size() > 0; }
  bool is_moment() const;
  /// True from the first moment to the last, both included.
  bool holds_at(int phase, double fraction) const;
};

/// Whether a term reads velocities.
bool reads_rates(const Term& term);

/// A violation of a limit in this unit that counts as one: "m" the robot's size, "rad" one, "m/s" and "rad/s" those of
/// a pendulum of its size, anything else one.
double natural_size(const RobotModel& robot, const std::string& unit);

/// Tolerance of the certificate in this unit: that of goals for "m", "rad", "m/s" and "rad/s", else a thousandth.
double term_tolerance(const GoalTolerance& tolerance, const std::string& unit);

}  // namespace prowl

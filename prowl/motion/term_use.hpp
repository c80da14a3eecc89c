#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "prowl/motion/phase.hpp"
#include "prowl/terms/term.hpp"

namespace prowl {

struct MotionProblem;

/// A term in a motion: when it counts, and as a limit or as a cost.
///
///   limit   lower <= f <= upper, -inf and +inf where free. Equal bounds are exact at one moment; over a span the
///           bounds are at least the tolerance of the certificate apart, so that torques stay smooth.
///   cost    1/2 (f - reference)ᵀ W (f - reference), integrated over the span, or at the moment
///
/// Nodes of the mesh keep the limit; the certificate checks it between them, too.
struct TermUse {
  std::string name;                        ///< unique in the motion
  std::shared_ptr<const Term> term;        ///< shared by the copies of a problem
  PhaseFraction from = {}, to = {};        ///< first and last moment, both at nodes; equal for one moment
  Eigen::VectorXd lower = {}, upper = {};  ///< one entry for each row, in the term's unit; empty for a cost
  Eigen::VectorXd reference = {};          ///< likewise; empty for a limit
  Eigen::MatrixXd weight = {};             ///< W: rows x rows, symmetric, positive semidefinite; empty for a limit

  bool is_cost() const { return weight.size() > 0; }
  bool is_moment() const;
  /// True from the first moment to the last, both included; a span only in phases of which it has a part.
  bool holds_at(int phase, double fraction) const;
};

/// Whether a term reads velocities.
bool reads_rates(const Term& term);
/// Whether a term reads torques or forces, which may differ between the two nodes of a phase transition.
bool reads_loads(const Term& term);

/// Scale of a violation: Term::size(), or by the unit "m" the robot's size, "rad" one,
/// "m/s", "rad/s" and "N m s" those of a pendulum of its size and mass, "N" its weight, "N m" its weight times its
/// size, else one.
double natural_size(const RobotModel& robot, const Term& term);

/// Tolerance of the certificate: by the unit that of goals ("m", "rad", "m/s", "rad/s") or of contact forces ("N"),
/// else a thousandth of natural_size().
double term_tolerance(const MotionProblem& problem, const Term& term);

}  // namespace prowl

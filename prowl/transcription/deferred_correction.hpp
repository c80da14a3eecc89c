#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Constants that the trapezoid adds to the steps of a motion. One vector (2 nv) per node, for the interval that ends
/// there; empty at the first node of a phase. Rows: base position [m], rotation vector between the two half turns of
/// the base [rad], joints [rad or m], v. An empty list stands for zeros.
using Corrections = std::vector<Eigen::VectorXd>;

/// Deferred correction (Pereyra, Numerische Mathematik 8, 1966): the step of a rule of fourth order along a known
/// motion, less the step of the trapezoid. With these constants, the trapezoid's solution is of fourth order, and its
/// stages keep their size. The rule is Hermite-Simpson with torques linear in time (docs/transcription.md):
///
///   δq = h/3 (2 q̇_c - q̇_0 - q̇_1),   δv = h/3 (2 a_c - a_0 - a_1)
///
/// All accelerations follow from q, v and torque; c is the middle of the cubics of hermite_interval.hpp. `motion` has
/// one point per node of `discrete`. Throws NumericalError where the dynamics cannot be evaluated.
Corrections deferred_corrections(const DiscreteProblem& discrete, const Trajectory& motion);

/// Parts of the local integration error of one interval with cubics, of the worst coordinate, scaled by state_scale().
struct StepError {
  double correctable = 0.0;  ///< a change of the nodes removes it [-]
  double lasting = 0.0;      ///< only shorter steps lower it, with their fourth power [-]
};

/// One per mesh interval, in order. From four evaluations of the dynamics an interval, less than a tenth of the
/// certificate's.
std::vector<StepError> step_errors(const MotionProblem& problem, const Trajectory& motion);

}  // namespace prowl

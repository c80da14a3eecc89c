#pragma once

#include <string>
#include <vector>

#include "prowl/certificate/grade.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// What a finished motion may be off by; docs/verification.md says why these figures.
struct CertificateLimits {
  // Two where the grade depends on it.
  static constexpr double integration_error_certified = 1e-6;  ///< scaled, per interval and coordinate [-]
  static constexpr double integration_error_draft = 1e-4;      ///< [-]
  static constexpr double second_error_certified = 2e-4;       ///< the same, summed over any second [-]
  static constexpr double second_error_draft = 3e-3;           ///< [-]
  static constexpr double reintegration_certified = 5e-6;      ///< scaled, at the end of an interval [-]
  static constexpr double reintegration_draft = 5e-4;          ///< [-]
  static constexpr double defect = 1e-6;                       ///< scaled, also for the state at a phase switch [-]
  static constexpr double total_defect_certified = 1e-6;       ///< the same, summed over the motion [-]
  static constexpr double total_defect_draft = 1e-5;           ///< [-]
  static constexpr double start_state = 1e-6;                  ///< [m, rad, m/s, rad/s]
  static constexpr double phase_duration = 1e-6;               ///< [s]
  static constexpr double quaternion_norm = 1e-6;              ///< [-]
  static constexpr double contact_drift = 1e-3;                ///< [m]
  static constexpr double contact_velocity = 5e-3;             ///< [m/s]
  static constexpr double contact_gap = 1e-3;                  ///< off its surface, patch, place where it closes [m]
  static constexpr double penetration = 1e-3;                  ///< [m]
  static constexpr double missing_clearance = 0.1;             ///< of the clearance asked of swings [-]
  static constexpr double force_over_weight = 1e-2;  ///< friction, unilateral force, load before opening [body weight]
  static constexpr double planned_force_over_weight = 5e-2;  ///< planned against recovered force [body weight]
  static constexpr double contact_acceleration = 1e-3;       ///< left over by the constrained dynamics [m/s^2]
  static constexpr double torque_ratio = 1.001;              ///< of the joint's limit at its position and velocity [-]
  static constexpr double velocity_ratio = 1.001;            ///< of the joint's limit [-]
  static constexpr double joint_position = 1e-3;             ///< beyond the limit [rad] or [m]
  static constexpr double goal_torque = 1e-3;                ///< of the joint's limit [-]
  static constexpr double grid_step = 1e-3;                  ///< of the sampled checks [s]
  static constexpr int grid_intervals = 10;                  ///< at least, in a mesh interval
};

/// One thing that has to hold, at its worst moment.
struct CertificateCheck {
  std::string name;    ///< "contact drift", "friction cone", "joint torque", ...
  double worst = 0.0;  ///< in `unit`; NaN is a failure
  double limit = 0.0;  ///< passes if worst <= limit
  std::string unit;    ///< "m", "N", "N m", "-", ...; of the worst where several kinds of quantities are in one check
  double time = 0.0;   ///< when the worst happens [s]
  std::string where;   ///< contact or joint or coordinate, "" if none
  bool passed = false;
  double certified_limit = 0.0;  ///< what grade certified asks of `worst`; <= limit, most often the same
};

/// How far one mesh interval is off, at its largest coordinate, scaled [-].
struct IntervalError {
  double start = 0.0, end = 0.0;  ///< [s]
  double error = 0.0;             ///< local integration error
  std::string where;              ///< its coordinate of the state
  double reintegration = 0.0;     ///< of the state at its end, against the true motion from its start
};

/// Rows of the contact Jacobian of a phase, and how many of them are independent. The forces of `rank` combinations
/// follow from the motion; rows - rank are a choice.
struct ContactRank {
  std::string phase;
  int rows = 0, rank = 0;
};

/// Whether a finished motion is what was asked for, judged from the motion alone (docs/verification.md).
/// A check that has nothing to look at (a flight has no contact drift) is not in the list.
struct Certificate {
  bool passed = false;
  Grade grade = Grade::failed;  ///< failed if any check fails; certified if all are within their certified_limit
  std::vector<CertificateCheck> checks;
  std::vector<IntervalError> interval_errors;  ///< one a mesh interval, in order: where to refine the mesh
  /// Contacts with forces that the motion does not tell (points of a flat foot): they are one choice of many, the
  /// planner's, and only that one was checked against friction and pulling. In the robot's order.
  std::vector<std::string> redundant_contacts;
  std::vector<ContactRank> contact_ranks;  ///< one a phase, at its first node

  /// A check by its name; null if it is not in the list.
  const CertificateCheck* find(const std::string& name) const;
};

/// Re-evaluates everything by dynamics of its own (ConstrainedDynamicsOracle), without the projection and without the
/// transcription. Never throws because a motion is bad: that is a failed check. A motion whose nodes do not fit the
/// problem, or with a NaN or infinity in it, gets these checks only: the others would mean nothing.
Certificate certify(const DiscreteProblem& discrete, const Trajectory& trajectory);

}  // namespace prowl

#pragma once

#include <string>
#include <vector>

#include "prowl/certificate/certificate_grade.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// Limits of the checks of a finished motion; docs/verification.md explains the values.
struct CertificateLimits {
  // In pairs where the grade depends on them.
  static constexpr double integration_error_certified = 1e-6;  ///< scaled, per interval and coordinate [-]
  static constexpr double integration_error_draft = 1e-4;      ///< [-]
  static constexpr double second_error_certified = 2e-4;       ///< the same, summed over any second [-]
  static constexpr double second_error_draft = 3e-3;           ///< [-]
  static constexpr double reintegration_certified = 5e-6;      ///< scaled, at the end of an interval [-]
  static constexpr double reintegration_draft = 5e-4;          ///< [-]
  static constexpr double defect = 1e-6;                       ///< scaled; also of the state at a phase transition [-]
  static constexpr double total_defect_certified = 1e-6;       ///< the same, summed over the motion [-]
  static constexpr double total_defect_draft = 1e-5;           ///< [-]
  static constexpr double start_state = 1e-6;                  ///< [m, rad, m/s, rad/s]
  static constexpr double phase_duration = 1e-6;               ///< [s]
  static constexpr double quaternion_norm = 1e-6;              ///< [-]
  static constexpr double contact_drift = 1e-3;                ///< [m]
  static constexpr double contact_velocity = 5e-3;             ///< [m/s]
  static constexpr double contact_gap = 1e-3;                  ///< from surface, patch, foothold at landing [m]
  static constexpr double penetration = 1e-3;                  ///< [m]
  static constexpr double missing_clearance = 0.1;             ///< missing part of the swing clearance [-]
  static constexpr double force_over_weight = 1e-2;            ///< friction, pull, load before opening [body weight]
  static constexpr double planned_force_over_weight = 5e-2;    ///< planned against recovered force [body weight]
  static constexpr double contact_acceleration = 1e-3;         ///< residual of the constrained dynamics [m/s²]
  static constexpr double torque_ratio = 1.001;                ///< torque / limit at this position and velocity [-]
  static constexpr double velocity_ratio = 1.001;              ///< velocity / limit [-]
  static constexpr double joint_position = 1e-3;               ///< beyond the limit [rad] or [m]
  static constexpr double goal_torque = 1e-3;                  ///< violation / limit [-]
  static constexpr double grid_step = 1e-3;                    ///< largest, of the sampled checks [s]
  static constexpr int grid_intervals = 10;                    ///< fewest per mesh interval
};

/// One limit, and the worst value over the motion.
struct CertificateCheck {
  std::string name;    ///< "contact drift", "friction cone", "joint torque", ...
  double worst = 0.0;  ///< in `unit`; NaN is a failure
  double limit = 0.0;  ///< passes if worst <= limit
  std::string unit;    ///< "m", "N", "N m", "-", ...; of the worst value if the check mixes quantities
  double time = 0.0;   ///< when the worst happens [s]
  std::string where;   ///< contact or joint or coordinate, "" if none
  bool passed = false;
  double certified_limit = 0.0;       ///< limit of grade certified; <= limit, usually equal
  std::vector<double> failures = {};  ///< all times at which a value was beyond `limit` [s]; not in files
};

/// Errors of one mesh interval, of its worst coordinate, scaled [-].
struct IntervalError {
  double start = 0.0, end = 0.0;  ///< [s]
  double error = 0.0;             ///< local integration error
  std::string where;              ///< worst coordinate of the state
  double reintegration = 0.0;     ///< of the state at `end`, see reintegration.hpp
};

/// Rows and rank of the contact Jacobian of a phase. The motion determines `rank` combinations of the contact forces;
/// the other rows - rank are free.
struct ContactRank {
  std::string phase;
  int rows = 0, rank = 0;
};

/// Verdict on a finished motion, from the motion alone (docs/verification.md). Checks without data (contact drift of a
/// flight) are not in the list.
struct Certificate {
  bool passed = false;
  CertificateGrade grade =
      CertificateGrade::failed;  ///< failed if any check fails; certified if all are within their certified_limit
  std::vector<CertificateCheck> checks;
  std::vector<IntervalError> interval_errors;  ///< one per mesh interval, in order
  /// Contacts whose forces the motion does not determine (points of a flat foot), in the robot's order. Friction and
  /// pull are checked only for the forces that the planner chose.
  std::vector<std::string> redundant_contacts;
  std::vector<ContactRank> contact_ranks;  ///< one per phase, at its first node

  /// A check by its name; null if it is not in the list.
  const CertificateCheck* find(const std::string& name) const;
};

/// Checks the motion with other dynamics than the planner's (ConstrainedDynamicsOracle). A bad motion fails a check and
/// never throws. If the nodes do not fit the problem, or a number is not finite, only these checks run.
Certificate certify(const DiscreteProblem& discrete, const Trajectory& trajectory);

}  // namespace prowl

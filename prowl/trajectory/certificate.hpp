#pragma once

#include <string>
#include <vector>

#include "prowl/motion/motion_problem.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

enum class Grade { failed, draft, certified };

/// One thing that has to hold, at its worst moment.
struct CertificateCheck {
  std::string name;      ///< "contact drift", "friction cone", "joint torque", ...
  double worst = 0.0;    ///< in `unit`; NaN is a failure
  double limit = 0.0;    ///< passes if worst <= limit
  std::string unit;      ///< "m", "N", "N m", "-", ...
  double time = 0.0;     ///< when the worst happens [s]
  std::string where;     ///< contact or joint or coordinate, "" if none
  bool passed = false;
};

/// Whether a finished motion is what was asked for, judged from the motion alone (docs: verification).
struct Certificate {
  bool passed = false;
  Grade grade = Grade::failed;
  std::vector<CertificateCheck> checks;
};

const char* to_string(Grade grade);

/// Re-evaluates everything by Pinocchio's own constrained dynamics, without the projection and without the
/// transcription. Never throws because a motion is bad: that is a failed check.
Certificate certify(const MotionProblem& problem, const Trajectory& trajectory);

}  // namespace prowl

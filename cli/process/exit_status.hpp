#pragma once

#include "prowl/plan.hpp"

namespace prowl::cli {

/// Exit status of the command; scripts rely on these values.
enum ExitStatus : int {
  kPassed = 0,      ///< the plan passes its certificate, draft or certified
  kUnexpected = 1,  ///< a bug in Prowl
  kBadInput = 2,
  kNotSolved = 3,  ///< infeasible, less robust than asked, or the solver failed
  kFiles = 4,      ///< disk, permissions
  kNumericalFailure = 5,
  kLimit = 6,              ///< of time or iterations
  kCertificateFailed = 7,  ///< converged, but the certificate fails
  kSimulationFailed = 8,   ///< the criteria of the judge are not met
  kInterrupted = 130,
};

inline ExitStatus exit_status(SolveStatus status, const Certificate& certificate) {
  switch (status) {
    case SolveStatus::converged: return certificate.passed ? kPassed : kCertificateFailed;
    case SolveStatus::infeasible:
    case SolveStatus::solver_failed: return kNotSolved;
    case SolveStatus::evaluation_failed: return kNumericalFailure;
    case SolveStatus::iteration_limit:
    case SolveStatus::time_limit: return kLimit;
    case SolveStatus::interrupted: return kInterrupted;
  }
  return kUnexpected;
}

}  // namespace prowl::cli

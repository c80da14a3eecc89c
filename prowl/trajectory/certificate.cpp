#include "prowl/trajectory/certificate.hpp"

#include <algorithm>

#include "prowl/trajectory/integration_error.hpp"
#include "prowl/trajectory/mesh_interval.hpp"
#include "prowl/trajectory/node_checks.hpp"
#include "prowl/trajectory/reintegration.hpp"
#include "prowl/trajectory/sampled_limits.hpp"
#include "prowl/trajectory/worst_case.hpp"

namespace prowl {
namespace {

PhaseDynamics phase_dynamics(const MotionProblem& problem) {
  PhaseDynamics dynamics;
  for (const Phase& phase : problem.phases) {
    std::vector<int> contacts;
    for (const PhaseContact& held : phase.contacts) contacts.push_back(held.contact);
    dynamics.emplace_back(problem.robot, contacts);
  }
  return dynamics;
}

CertificateCheck integration_check(const std::vector<IntervalError>& errors) {
  WorstCase worst("local integration error", "-", CertificateLimits::integration_error_draft);
  for (const IntervalError& interval : errors) worst.record(interval.error, interval.start, interval.where);
  return worst.check();
}

bool all_passed(const std::vector<CertificateCheck>& checks) {
  return std::all_of(checks.begin(), checks.end(), [](const CertificateCheck& check) { return check.passed; });
}

}  // namespace

const char* to_string(Grade grade) {
  switch (grade) {
    case Grade::certified:
      return "certified";
    case Grade::draft:
      return "draft";
    case Grade::failed:
      break;
  }
  return "failed";
}

Certificate certify(const MotionProblem& problem, const Trajectory& trajectory) {
  Certificate certificate;
  auto& checks = certificate.checks;
  checks.push_back(structure_check(problem, trajectory));
  if (!checks.back().passed) return certificate;
  checks.push_back(finite_check(trajectory));
  if (!checks.back().passed) return certificate;

  PhaseDynamics dynamics = phase_dynamics(problem);
  certificate.interval_errors = integration_errors(problem.robot, trajectory, dynamics);
  const CertificateCheck integration = integration_check(certificate.interval_errors);
  checks.push_back(integration);
  checks.push_back(reintegration_check(problem.robot, trajectory, dynamics));
  for (const auto& group : {node_checks(problem, trajectory), sampled_limits(problem, trajectory, dynamics)}) {
    checks.insert(checks.end(), group.begin(), group.end());
  }

  certificate.passed = all_passed(checks);
  if (certificate.passed) {
    certificate.grade =
        integration.worst <= CertificateLimits::integration_error_certified ? Grade::certified : Grade::draft;
  }
  return certificate;
}

}  // namespace prowl

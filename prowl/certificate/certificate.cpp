#include "prowl/certificate/certificate.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/certificate/contact_events.hpp"
#include "prowl/certificate/contact_states.hpp"
#include "prowl/certificate/integration_error.hpp"
#include "prowl/certificate/mesh_interval.hpp"
#include "prowl/certificate/node_checks.hpp"
#include "prowl/certificate/reintegration.hpp"
#include "prowl/certificate/sampled_limits.hpp"

namespace prowl {
namespace {

PhaseDynamics phase_dynamics(const MotionProblem& problem) {
  PhaseDynamics dynamics;
  for (const Phase& phase : problem.phases) dynamics.emplace_back(problem.robot, contact_indices(phase.contacts));
  return dynamics;
}

/// Finds the contacts whose forces have an internal part.
void find_redundant_contacts(const DiscreteProblem& discrete, const Trajectory& trajectory, PhaseDynamics& dynamics,
                             Certificate& certificate) {
  const MotionProblem& problem = discrete.problem;
  const RobotModel& robot = problem.robot;
  std::vector<bool> is_redundant(robot.contacts().size(), false);
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const TrajectoryPoint& node = trajectory.nodes[discrete.mesh.first_node(static_cast<int>(p))];
    dynamics[p].evaluate(node.q, node.v, node.tau);
    double free = 0.0;  // dimension of the free forces: the trace of their projector
    for (Eigen::Index i = 0; i < node.force.size(); ++i) {
      const Eigen::VectorXd internal = dynamics[p].internal_part(Eigen::VectorXd::Unit(node.force.size(), i));
      free += internal(i);
      if (internal.norm() > 1e-6) is_redundant[i / 3] = true;  // of 1; below it is rounding
    }
    const int rows = 3 * static_cast<int>(problem.phases[p].contacts.size());
    certificate.contact_ranks.push_back({problem.phases[p].name, rows, rows - static_cast<int>(std::lround(free))});
  }
  for (std::size_t c = 0; c < is_redundant.size(); ++c) {
    if (is_redundant[c]) certificate.redundant_contacts.push_back(robot.contacts()[c].name);
  }
}

CertificateGrade grade_of(const std::vector<CertificateCheck>& checks) {
  if (!std::ranges::all_of(checks, &CertificateCheck::passed)) return CertificateGrade::failed;
  const auto is_certified = [](const CertificateCheck& check) { return check.worst <= check.certified_limit; };
  return std::ranges::all_of(checks, is_certified) ? CertificateGrade::certified : CertificateGrade::draft;
}

}  // namespace

const CertificateCheck* Certificate::find(const std::string& name) const {
  const auto found = std::ranges::find(checks, name, &CertificateCheck::name);
  return found == checks.end() ? nullptr : &*found;
}

Certificate certify(const DiscreteProblem& discrete, const Trajectory& trajectory) {
  const MotionProblem& problem = discrete.problem;
  Certificate certificate;
  auto& checks = certificate.checks;
  checks.push_back(structure_check(discrete, trajectory));
  if (!checks.back().passed) return certificate;
  checks.push_back(finite_check(trajectory));
  if (!checks.back().passed) return certificate;

  PhaseDynamics dynamics = phase_dynamics(problem);
  const IntegrationErrors errors = integration_errors(problem.robot, trajectory, dynamics);
  const ReintegrationErrors reintegrated = reintegration_errors(problem.robot, trajectory, dynamics);
  certificate.interval_errors = errors.intervals;
  for (std::size_t i = 0; i < reintegrated.intervals.size(); ++i) {
    certificate.interval_errors[i].reintegration = reintegrated.intervals[i];
  }
  find_redundant_contacts(discrete, trajectory, dynamics, certificate);
  const ContactStates states = contact_states(discrete, trajectory, dynamics);
  for (const auto& group : {errors.checks,
                            {reintegrated.check},
                            node_checks(discrete, trajectory),
                            contact_event_checks(discrete, trajectory, states, dynamics),
                            sampled_limits(discrete, trajectory, states, dynamics)}) {
    checks.insert(checks.end(), group.begin(), group.end());
  }
  certificate.grade = grade_of(checks);
  certificate.passed = certificate.grade != CertificateGrade::failed;
  return certificate;
}

}  // namespace prowl

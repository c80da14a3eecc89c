#include "prowl/session/warm_start.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/mesh/resample.hpp"

namespace prowl {

Trajectory warm_start(const PlanRecord& record, const DiscreteProblem& asked) {
  const MotionProblem& problem = asked.problem;
  const MotionProblem& other = record.task.problem;
  if (other.robot.joint_names() != problem.robot.joint_names()) {
    throw InputError("the motion to start from is of another robot");
  }
  resample(record.plan.trajectory, asked);
  for (std::size_t p = 0; p < problem.phases.size(); ++p) {
    const auto contact = &PhaseContact::contact;
    if (std::ranges::equal(problem.phases[p].contacts, other.phases[p].contacts, {}, contact, contact)) continue;
    throw InputError(fmt::format("the motion to start from has other contacts in phase {}", p + 1));
  }
  return record.plan.trajectory;
}

}  // namespace prowl

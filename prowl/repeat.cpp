#include "prowl/repeat.hpp"

#include <algorithm>

namespace prowl {

namespace {

/// The same motion one cycle later.
TrajectoryPoint next_cycle(const Cycle& cycle, TrajectoryPoint point, double duration, int phases) {
  point.time += duration;
  point.phase += phases;
  point.q = cycle.moved_configuration(point.q);
  for (Eigen::Index i = 0; i < point.force.size(); i += 3)
    point.force.segment<3>(i) = cycle.rotation() * point.force.segment<3>(i).eval();
  return point;
}

Trajectory repeated(const MotionProblem& problem, const Trajectory& one) {
  Trajectory all = one;
  const std::size_t nodes = one.nodes.size(), torques = one.middle_torques.size();
  for (int i = 1; i < problem.cycle->count; ++i) {
    for (std::size_t k = 0; k < nodes; ++k) {
      const TrajectoryPoint& before = all.nodes[all.nodes.size() - nodes];
      all.nodes.push_back(next_cycle(*problem.cycle, before, one.duration(), problem.phases_of_cycle()));
    }
    for (std::size_t k = 0; k < torques; ++k) all.middle_torques.push_back(one.middle_torques[k]);
  }
  return all;
}

}  // namespace

bool has_repetitions(const MotionProblem& problem) { return problem.cycle && problem.cycle->count > 1; }

DiscreteProblem first_cycle(const DiscreteProblem& asked) {
  MotionProblem problem = asked.problem;
  Mesh mesh = asked.mesh;
  const int count = problem.phases_of_cycle();
  problem.phases.erase(problem.phases.begin() + count, problem.phases.end());
  mesh.phases.erase(mesh.phases.begin() + count, mesh.phases.end());
  problem.cycle->count = 1;
  for (TermUse& use : problem.terms) use.to = PhaseFraction::end_of(count - 1);  // all are over the whole motion
  return {std::move(problem), std::move(mesh)};
}

PlanOptions options_of_cycle(const DiscreteProblem& asked, PlanOptions options) {
  Trajectory& warm_start = options.warm_start;
  const int phases = asked.problem.phases_of_cycle();
  std::erase_if(warm_start.nodes, [&](const TrajectoryPoint& point) { return point.phase >= phases; });
  if (!warm_start.middle_torques.empty())
    warm_start.middle_torques.resize(std::min(warm_start.middle_torques.size(), warm_start.nodes.size() - phases));
  options.on_iterate = {};
  return options;
}

void repeat(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options, Plan& plan) {
  const Mesh one = plan.mesh;
  plan.trajectory = repeated(asked.problem, plan.trajectory);
  for (int i = 1; i < asked.problem.cycle->count; ++i)
    plan.mesh.phases.insert(plan.mesh.phases.end(), one.phases.begin(), one.phases.end());
  plan.result.stage_multipliers.clear();
  judge(asked, solver, options, plan);
}

}  // namespace prowl

#pragma once

#include <functional>
#include <vector>

#include "prowl/elastic/breach.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

struct ElasticResult {
  SolveStatus status = SolveStatus::solver_failed;
  std::vector<Breach> breaches;  ///< one per limit and phase, most expensive first; none below 0.1 % of its size
  Trajectory motion;             ///< that breaches least, or the last iterate
};

/// Solves the problem with slacks on the limits for which `gives_way` returns true (ElasticNlp); dynamics, start,
/// contacts and landings stay hard. A slack costs in proportion to its node's share of the motion's time, so the result
/// does not depend on the mesh. The tolerance is at least 1e-5, the limit of iterations 500. A small part of the task's
/// cost selects a smooth motion among those that breach least.
ElasticResult elastic_solve(const DiscreteProblem& discrete, const NlpSolver& solver, SolverOptions options,
                            const std::function<bool(const MotionLimit&)>& gives_way);
/// The same with slacks on all limits.
ElasticResult elastic_solve(const DiscreteProblem& discrete, const NlpSolver& solver, SolverOptions options);

}  // namespace prowl

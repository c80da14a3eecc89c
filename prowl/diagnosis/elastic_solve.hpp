#pragma once

#include <functional>
#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

/// A limit that gives way in an elastic solve, at its worst node.
struct Breach {
  LimitKind kind = LimitKind::friction;
  int phase = 0;
  double time = 0.0;    ///< in the motion of the elastic solve [s]
  std::string subject;  ///< contact, joint, or entry of a goal
  double amount = 0.0;  ///< violation > 0, in `unit`
  std::string unit;
  double relative = 0.0;  ///< amount / MotionLimit::size
  double total = 0.0;     ///< price over all nodes
};

struct ElasticResult {
  SolveStatus status = SolveStatus::solver_failed;
  std::vector<Breach> breaches;  ///< one per limit and phase, most expensive first; none below 0.1 % of its size
};

/// Solves the problem with slacks on the limits for which `gives_way` returns true (ElasticNlp); dynamics, start,
/// contacts and landings stay hard. A slack costs in proportion to its node's share of the motion's time, so the result
/// does not depend on the mesh. A small part of the task's cost selects a smooth motion among those that breach least.
ElasticResult elastic_solve(const DiscreteProblem& discrete, const NlpSolver& solver, const SolverOptions& options,
                            const std::function<bool(const MotionLimit&)>& gives_way);

}  // namespace prowl

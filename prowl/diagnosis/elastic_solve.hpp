#pragma once

#include <functional>
#include <string>
#include <vector>

#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/transcription/node/motion_limit.hpp"

namespace prowl {

/// A limit that gives way in an elastic solve, where it does so most.
struct Breach {
  LimitKind kind = LimitKind::friction;
  int phase = 0;
  double time = 0.0;    ///< in the motion of the elastic solve, which chooses free durations [s]
  std::string subject;  ///< contact, joint, or what a goal is about
  double amount = 0.0;  ///< how much is missing, > 0, in `unit`
  std::string unit;
  double relative = 0.0;  ///< amount / MotionLimit::size
  double total = 0.0;     ///< over all nodes, as priced
};

struct ElasticResult {
  SolveStatus status = SolveStatus::solver_failed;
  std::vector<Breach>
      breaches;  ///< one for each limit and phase, those that cost most first; none below 0.1 % of their size
};

/// Solves the problem once more with limits that give way (ElasticNlp): dynamics, start, contacts and landings stay
/// hard, and the limits for which `gives_way` says so have slacks. What holds at every node costs in proportion to its
/// part of the motion's time, so that the answer does not depend on the mesh. The task's own cost counts for little: of
/// all motions that breach least, a smooth one.
ElasticResult elastic_solve(const DiscreteProblem& discrete, const NlpSolver& solver, const SolverOptions& options,
                            const std::function<bool(const MotionLimit&)>& gives_way);

}  // namespace prowl

#pragma once

#include <string>

#include "prowl/diagnosis/change_search.hpp"
#include "prowl/diagnosis/diagnosis.hpp"
#include "prowl/plan.hpp"

namespace prowl {

/// Shared by the parts of a diagnosis. The references must outlive it.
struct DiagnosisRun {
  DiagnosisRun(const DiscreteProblem& problem, const NlpSolver& solver, const NlpSolver& elastic,
               const DiagnosisOptions& options);

  void step(const std::string& what) const;
  /// Plans as prowl plan does, in a part of the remaining time. `seconds_before` were already spent on this plan.
  Plan planned(const DiscreteProblem& of, double part, PlanOptions with = {}, double seconds_before = 0.0) const;
  /// Reason why a plan was stopped early, in words; "" if it was not.
  std::string what_stopped(const SolveResult& plan) const;

  const DiscreteProblem& problem;
  const NlpSolver& solver;
  const NlpSolver& elastic;
  const DiagnosisOptions& options;
  ChangeSearch search;
  DiscreteProblem searched;  ///< the problem on the search mesh
  Diagnosis result;
};

}  // namespace prowl

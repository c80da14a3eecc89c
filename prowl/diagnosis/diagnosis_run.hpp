#pragma once

#include <string>

#include "prowl/diagnosis/change_search.hpp"
#include "prowl/diagnosis/diagnosis.hpp"
#include "prowl/plan.hpp"

namespace prowl {

/// What the parts of a diagnosis share. The references must outlive it.
struct DiagnosisRun {
  DiagnosisRun(const DiscreteProblem& problem, const NlpSolver& solver, const NlpSolver& elastic,
               const DiagnosisOptions& options);

  /// Tells who asked what is being done.
  void step(const std::string& what) const;
  /// As prowl plan does, in a part of the time that is left, of which so much was spent on it before.
  Plan planned(const DiscreteProblem& of, double part, PlanOptions with = {}, double seconds_before = 0.0) const;
  /// What stopped a plan before its end, in words; "" if nothing did.
  std::string what_stopped(const SolveResult& plan) const;

  const DiscreteProblem& problem;
  const NlpSolver& solver;
  const NlpSolver& elastic;
  const DiagnosisOptions& options;
  ChangeSearch search;
  DiscreteProblem searched;  ///< the problem on the mesh of the search
  Diagnosis result;
};

}  // namespace prowl

#pragma once

#include <vector>

#include "prowl/solvers/riccati/riccati_solver.hpp"

namespace prowl::test {

/// Solves so many programs, and says of so many after them that it has stopped.
class FailingSolver : public NlpSolver {
 public:
  FailingSolver(int solves, SolveStatus status, int failures = 1000)
      : left_(solves), failures_(failures), status_(status) {}
  std::string name() const override { return solver_.name(); }
  std::string version() const override { return solver_.version(); }
  std::optional<std::string> why_unsupported(Nlp& nlp) const override { return solver_.why_unsupported(nlp); }
  SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const override {
    SolveResult result = solver_.solve(nlp, z_guess, options);
    guesses.push_back(z_guess);
    ends.push_back(result.z);
    if (left_-- <= 0 && failures_-- > 0) result.status = status_;
    return result;
  }

  mutable std::vector<Eigen::VectorXd> guesses, ends;  ///< of each solve

 private:
  RiccatiSolver solver_;
  mutable int left_, failures_;
  SolveStatus status_;
};

}  // namespace prowl::test

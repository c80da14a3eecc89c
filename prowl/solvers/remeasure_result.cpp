#include "prowl/solvers/remeasure_result.hpp"

#include <limits>

#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/solvers/guarded_nlp.hpp"

namespace prowl {

void remeasure_result(Nlp& nlp, double tolerance, const std::string& solver, SolveResult& result) {
  using enum SolveStatus;
  GuardedNlp guarded(nlp);
  Eigen::VectorXd rows(nlp.num_constraints());
  if (guarded.finite_point(result.z) && guarded.cost(result.z, result.cost) && guarded.constraints(result.z, rows)) {
    result.constraint_violation = constraint_violation(nlp, result.z, rows);
  } else {
    result.cost = result.constraint_violation = std::numeric_limits<double>::quiet_NaN();
    const bool has_reason =
        result.status == solver_failed || result.status == evaluation_failed;  // reason known already
    if (!has_reason) {
      result.status = guarded.broken() ? solver_failed : evaluation_failed;
      result.message = "result cannot be evaluated: " + guarded.failure();
    }
  }
  if (result.status == converged && !(result.constraint_violation <= tolerance)) {
    result.status = solver_failed;
    result.message = solver + " reports convergence, but a constraint is not within tolerance";
  }
}

}  // namespace prowl

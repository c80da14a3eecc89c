#include "prowl/solvers/judge.hpp"

#include <limits>

#include "prowl/error.hpp"
#include "prowl/nlp/constraint_violation.hpp"

namespace prowl {

void judge(Nlp& nlp, double tolerance, const std::string& solver, SolveResult& result) {
  try {
    Eigen::VectorXd rows(nlp.num_constraints());
    nlp.constraints(result.z, rows);
    result.cost = nlp.cost(result.z);
    result.constraint_violation = constraint_violation(nlp, result.z, rows);
  } catch (const NumericalError& error) {
    result.status = SolveStatus::evaluation_failed;
    result.message = error.what();
    result.cost = result.constraint_violation = std::numeric_limits<double>::quiet_NaN();
  }
  if (result.status == SolveStatus::converged && !(result.constraint_violation <= tolerance)) {
    result.status = SolveStatus::solver_failed;
    result.message = solver + " says it is done, but a constraint is not within tolerance";
  }
}

}  // namespace prowl

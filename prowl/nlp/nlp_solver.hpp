#pragma once

#include <Eigen/Core>
#include <atomic>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "prowl/nlp/nlp.hpp"

namespace prowl {

/// Why the solver stopped. The certificate decides if the result is good.
enum class SolveStatus {
  converged,
  infeasible,  ///< converged to a local minimum of the constraint violation
  iteration_limit,
  time_limit,
  interrupted,
  evaluation_failed,  ///< NaN, infinity or a NumericalError in the problem
  solver_failed,
};
const char* to_string(SolveStatus status);

struct SolveProgress {
  int iteration = 0;
  double cost = 0.0;
  double constraint_violation = 0.0;  ///< max norm, unscaled
  double dual_violation = 0.0;
  double elapsed_seconds = 0.0;
};

struct SolverOptions {
  double tolerance = 1e-6;  ///< on optimality and on constraint violation
  int max_iterations = 300;
  double max_seconds = 300.0;
  int threads = 1;             ///< for evaluations; results do not depend on it
  bool is_warm_start = false;  ///< it solves a neighbouring problem: stay near it
  /// Multipliers of that solution (SolveResult::stage_multipliers) with equal sizes of stages, for solvers that use
  /// stages; may be empty. Riccati then takes full first steps without its filter, and undoes them if they lead away.
  std::vector<StageMultipliers> warm_start_multipliers = {};
  std::function<void(const SolveProgress&)> on_iteration;  ///< may be empty
  /// Variables of the iterate of the last on_iteration; may be empty, which saves gathering them.
  std::function<void(const Eigen::VectorXd& z)> on_iterate;
  const std::atomic<bool>* interrupt = nullptr;  ///< checked once per iteration; true stops
};

/// Throws InputError that names the invalid option.
void validate(const SolverOptions& options);

/// Times of a solve [s]. The rest of `cpu` is the solver's own: line search, output, memory.
struct SolveTimes {
  double cpu = 0.0;             ///< of all threads
  double values = 0.0;          ///< wall time in the problem's cost and constraints
  double derivatives = 0.0;     ///< wall time in their derivatives, first and second
  double linear_algebra = 0.0;  ///< wall time in Newton's equations; 0 if unknown
  double guess = 0.0;           ///< wall time of the initial guess, before the solve

  double evaluation() const { return values + derivatives; }
  SolveTimes& operator+=(const SolveTimes& other);
};

struct SolveResult {
  SolveStatus status = SolveStatus::solver_failed;
  std::string message;                              ///< from the solver, with the place of a failure
  Eigen::VectorXd z;                                ///< the solution, or the iterate of least violation
  Eigen::VectorXd multipliers;                      ///< of g at z; empty if unknown
  std::vector<StageMultipliers> stage_multipliers;  ///< of the stages at z; empty if unknown
  double cost = 0.0;
  double constraint_violation = 0.0;
  double dual_violation = 0.0;
  int iterations = 0;
  int pivoted_stages = 0;  ///< in the last linear system: stages without well-determined accelerations; 0 if unknown
  double seconds = 0.0;
  SolveTimes times;
};

class NlpSolver {
 public:
  virtual ~NlpSolver() = default;
  virtual std::string name() const = 0;
  virtual std::string version() const = 0;
  /// Reason, for the user, why this solver cannot solve the problem; none if it can.
  virtual std::optional<std::string> why_unsupported(Nlp& nlp) const = 0;
  /// A hard problem gives a status and never throws.
  virtual SolveResult solve(Nlp& nlp, const Eigen::VectorXd& z_guess, const SolverOptions& options) const = 0;
};

}  // namespace prowl

#include "prowl/solvers/foreign/uno_solver.hpp"

#include <fmt/format.h>
#include <uno/Uno_C_API.h>

#include <exception>
#include <limits>
#include <memory>
#include <mutex>

#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/iterate.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solvers/arguments.hpp"
#include "prowl/solvers/foreign/library_release.hpp"
#include "prowl/solvers/guarded_nlp.hpp"
#include "prowl/solvers/remeasure_result.hpp"
#include "prowl/solvers/thrown_error.hpp"

namespace prowl {
namespace {

using Eigen::VectorXd;
using VectorMap = Eigen::Map<VectorXd>;
using ConstVectorMap = Eigen::Map<const VectorXd>;
using Handle = std::unique_ptr<void, void (*)(void*)>;

struct Iterate : IterateFigures {
  VectorXd z;
};

/// Thrown through Uno and the Fortran of BQPD. Otherwise they would retry with ever smaller trust
/// regions.
struct Stopped {
  SolveStatus status;
  std::string message;
};

/// Adapter from Uno to the Nlp. During feasibility restoration Uno appends its own variables to
/// those of the Nlp.
class UnoProblem {
 public:
  UnoProblem(GuardedNlp& guarded, const SolverOptions& options, double began)
      : guarded_(guarded),
        nlp_(guarded.nlp()),
        options_(options),
        began_(began),
        g_(nlp_.num_constraints()),
        hessian_(nlp_.hessian_pattern().size()) {}

  const Iterate& best() const { return best_; }
  int iterations() const { return iterations_; }

  bool cost(const double* z, double& value) { return guarded_.cost(point(z), value); }
  bool cost_gradient(const double* z, double* gradient) {
    return guarded_.cost_gradient(point(z), VectorMap(gradient, nlp_.num_variables()));
  }
  bool constraints(const double* z, double* g) { return guarded_.constraints(point(z), VectorMap(g, g_.size())); }
  bool jacobian(const double* z, double* values) {
    return guarded_.jacobian(point(z), VectorMap(values, nlp_.jacobian_pattern().size()));
  }

  /// product = (Hessian of cost_factor f + multipliers . g at z) direction. Uno does not tell when
  /// the Hessian changes.
  bool hessian_product(const double* z, double cost_factor, const double* multipliers, const double* direction,
                       double* product) {
    const VectorXd& z_now = point(z);
    const ConstVectorMap multipliers_now(multipliers, g_.size());
    if (hessian_z_.size() == 0 || z_now != hessian_z_ || cost_factor != hessian_factor_ ||
        multipliers_now != hessian_multipliers_) {
      hessian_z_.resize(0);  // invalid until evaluated
      if (!guarded_.hessian(z_now, cost_factor, multipliers_now, hessian_)) return false;
      hessian_z_ = z_now;
      hessian_factor_ = cost_factor;
      hessian_multipliers_ = multipliers_now;
    }
    const SparsityPattern& pattern = nlp_.hessian_pattern();
    VectorMap(product, z_now.size()).setZero();
    for (int i = 0; i < pattern.size(); ++i) {
      product[pattern.rows[i]] += hessian_[i] * direction[pattern.cols[i]];
      if (pattern.rows[i] != pattern.cols[i]) product[pattern.cols[i]] += hessian_[i] * direction[pattern.rows[i]];
    }
    return true;
  }

  /// Start, with zero multipliers.
  void begin(const VectorXd& z) {
    Iterate first{{}, z};
    VectorXd gradient(z.size());
    const bool good = guarded_.finite_point(z) && guarded_.cost_gradient(z, gradient);
    first.dual_violation = gradient.lpNorm<Eigen::Infinity>();
    if (good && note(std::move(first))) return;
    throw Stopped{guarded_.broken() ? SolveStatus::solver_failed : SolveStatus::evaluation_failed,
                  fmt::format("start: {}", guarded_.failure())};
  }

  /// Called once per iteration.
  void iterate(const double* z, double dual_violation) {
    ++iterations_;
    Iterate now{{}, ConstVectorMap(z, nlp_.num_variables())};
    now.dual_violation = dual_violation;
    note(std::move(now));
    check_limits();
    guarded_.forget_failure();  // resolved by a smaller trust region
  }

 private:
  /// Called before every evaluation.
  const VectorXd& point(const double* z) {
    check_limits();
    z_ = ConstVectorMap(z, nlp_.num_variables());
    return z_;
  }

  bool note(Iterate now) {
    if (!guarded_.cost(now.z, now.cost) || !guarded_.constraints(now.z, g_)) return false;
    now.violation = constraint_violation(nlp_, now.z, g_);
    if (options_.on_iteration) {
      options_.on_iteration({iterations_, now.cost, now.violation, now.dual_violation, wall_seconds() - began_});
    }
    if (options_.on_iterate) options_.on_iterate(now.z);
    if (is_better(now, best_, options_.tolerance)) best_ = std::move(now);
    return true;
  }

  void check_limits() const {
    if (guarded_.broken()) throw Stopped{SolveStatus::solver_failed, guarded_.failure()};
    if (options_.interrupt && options_.interrupt->load()) throw Stopped{SolveStatus::interrupted, "stopped on request"};
    if (wall_seconds() - began_ > options_.max_seconds) throw Stopped{SolveStatus::time_limit, "time limit reached"};
  }

  GuardedNlp& guarded_;
  const Nlp& nlp_;
  const SolverOptions& options_;
  double began_;
  VectorXd z_, g_;
  VectorXd hessian_, hessian_z_, hessian_multipliers_;  ///< values and their point
  double hessian_factor_ = 0.0;
  Iterate best_;
  int iterations_ = 0;
};

UnoProblem& problem_of(void* self) { return *static_cast<UnoProblem*>(self); }
uno_int failed(bool good) { return good ? 0 : 1; }

uno_int give_cost(uno_int, const double* z, double* value, void* self) {
  return failed(problem_of(self).cost(z, *value));
}
uno_int give_gradient(uno_int, const double* z, double* gradient, void* self) {
  return failed(problem_of(self).cost_gradient(z, gradient));
}
uno_int give_constraints(uno_int, uno_int, const double* z, double* g, void* self) {
  return failed(problem_of(self).constraints(z, g));
}
uno_int give_jacobian(uno_int, uno_int, const double* z, double* values, void* self) {
  return failed(problem_of(self).jacobian(z, values));
}
uno_int give_hessian_product(uno_int, uno_int, const double* z, bool, double cost_factor, const double* multipliers,
                             const double* direction, double* product, void* self) {
  return failed(problem_of(self).hessian_product(z, cost_factor, multipliers, direction, product));
}
/// Uno 2.7.2 stops if this returns 0, contrary to its header.
uno_int tell_iteration(uno_int, uno_int, const double* z, const double*, const double*, const double*, double, double,
                       double stationarity, double, void* self) {
  problem_of(self).iterate(z, stationarity);
  return 1;
}

uno_int discard(const char*, uno_int length, void*) { return length; }

struct Outcome {
  SolveStatus status;
  const char* words;
};

Outcome outcome(uno_int ending, uno_int point) {
  using enum SolveStatus;
  if (ending == UNO_ITERATION_LIMIT) return {iteration_limit, "iteration limit reached"};
  if (ending == UNO_EVALUATION_ERROR) return {solver_failed, "an evaluation failed"};
  if (ending != UNO_SUCCESS) return {solver_failed, "no step could be found"};
  switch (point) {
    case UNO_FEASIBLE_KKT_POINT: return {converged, "optimal within tolerance"};
    case UNO_FEASIBLE_FJ_POINT: return {solver_failed, "feasible, but constraints depend on each other there"};
    case UNO_INFEASIBLE_STATIONARY_POINT:
      return {infeasible, "converged to a local minimum of the constraint violation"};
    case UNO_FEASIBLE_SMALL_STEP: return {solver_failed, "feasible, and steps became too small"};
    case UNO_INFEASIBLE_SMALL_STEP: return {solver_failed, "not feasible, and steps became too small"};
    case UNO_UNBOUNDED: return {solver_failed, "iterates diverge: the cost may have no lower bound"};
    default: return {solver_failed, "stopped at a point that is not within tolerance"};
  }
}

Handle make_model(Nlp& nlp, const VectorXd& z_guess, UnoProblem& problem) {
  Handle model(uno_create_model(UNO_PROBLEM_NONLINEAR, nlp.num_variables(), nlp.variable_lower().data(),
                                nlp.variable_upper().data(), UNO_ZERO_BASED_INDEXING),
               &uno_destroy_model);
  const SparsityPattern& pattern = nlp.jacobian_pattern();
  uno_set_objective(model.get(), UNO_MINIMIZE, &give_cost, &give_gradient);
  if (nlp.num_constraints() > 0) {
    uno_set_constraints(model.get(), nlp.num_constraints(), &give_constraints, nlp.constraint_lower().data(),
                        nlp.constraint_upper().data(), pattern.size(), pattern.rows.data(), pattern.cols.data(),
                        &give_jacobian);
  }
  uno_set_lagrangian_hessian_operator(model.get(), &give_hessian_product);
  uno_set_lagrangian_sign_convention(model.get(), UNO_MULTIPLIER_POSITIVE);
  uno_set_initial_primal_iterate(model.get(), z_guess.data());
  uno_set_user_data(model.get(), &problem);
  return model;
}

Handle configured_solver(const SolverOptions& options, UnoProblem& problem) {
  Handle solver(uno_create_solver(), &uno_destroy_solver);
  uno_set_solver_preset(solver.get(), "filtersqp");
  uno_set_solver_string_option(solver.get(), "QP_solver", "BQPD");
  uno_set_solver_string_option(solver.get(), "logger", "SILENT");
  uno_set_solver_string_option(solver.get(), "residual_norm", "INF");  // as in the other solvers
  // Uno accepts the loose tolerances if it makes no progress; equal values prevent this.
  for (const char* name : {"primal_tolerance", "loose_primal_tolerance", "dual_tolerance", "loose_dual_tolerance"}) {
    uno_set_solver_double_option(solver.get(), name, options.tolerance);
  }
  uno_set_solver_integer_option(solver.get(), "max_iterations", options.max_iterations);
  uno_set_solver_callbacks(solver.get(), nullptr, &tell_iteration, &problem);
  return solver;
}

/// Uno warns of fixed variables once per process, before it reads its option "logger".
struct Silence {
  Silence() { uno_set_logger_stream_callback(&discard, nullptr); }
  ~Silence() { uno_reset_logger_stream(); }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
};

void run_uno(Nlp& nlp, const VectorXd& z_guess, const SolverOptions& options, UnoProblem& problem,
             SolveResult& result) {
  static std::mutex one_at_a_time;
  const std::lock_guard<std::mutex> lock(one_at_a_time);
  const Silence silence;
  const Handle model = make_model(nlp, z_guess, problem), solver = configured_solver(options, problem);
  uno_optimize(solver.get(), model.get());

  const auto [status, words] =
      outcome(uno_get_optimization_status(solver.get()), uno_get_solution_status(solver.get()));
  result.status = status;
  result.message = words;
  result.iterations = uno_get_number_iterations(solver.get());
  if (status != SolveStatus::converged && status != SolveStatus::infeasible) return;
  result.z.resize(nlp.num_variables());
  uno_get_primal_solution(solver.get(), result.z.data());
  result.multipliers.resize(nlp.num_constraints());
  uno_get_constraint_dual_solution(solver.get(), result.multipliers.data());
  result.dual_violation = uno_get_solution_stationarity(solver.get());
}

}  // namespace

std::string UnoSolver::name() const { return "Uno"; }

std::string UnoSolver::version() const {
  uno_int major = 0, minor = 0, patch = 0;
  uno_get_version(&major, &minor, &patch);
  return fmt::format("{}.{}.{}", major, minor, patch);
}

std::optional<std::string> UnoSolver::why_unsupported(Nlp& nlp) const {
  const std::string built = fmt::format("{}.{}.{}", UNO_VERSION_MAJOR, UNO_VERSION_MINOR, UNO_VERSION_PATCH);
  if (auto reason = why_other_release("Uno", version(), built, "libuno.so")) return reason;
  return why_nothing_left(nlp);
}

SolveResult UnoSolver::solve(Nlp& nlp, const VectorXd& z_guess, const SolverOptions& options) const {
  check_arguments(nlp, z_guess, options);
  nlp.use_threads(options.threads);
  const double began = wall_seconds();
  const double cpu_began = cpu_seconds();
  GuardedNlp guarded(nlp);
  UnoProblem problem(guarded, options, began);
  SolveResult result;
  try {
    if (const auto reason = why_unsupported(nlp)) throw Stopped{SolveStatus::solver_failed, *reason};
    problem.begin(z_guess);
    run_uno(nlp, z_guess, options, problem, result);
  } catch (const Stopped& stopped) {
    result.status = stopped.status;
    result.message = stopped.message;
    result.iterations = problem.iterations();
  } catch (...) {
    result.message = "Uno: " + thrown_error();
    result.iterations = problem.iterations();
  }
  if (guarded.broken()) {
    result.status = SolveStatus::solver_failed;
    result.message = guarded.failure();
  }
  const bool gave_up = result.status == SolveStatus::solver_failed && !guarded.broken();
  if (gave_up && !guarded.failure().empty()) {
    result.status = SolveStatus::evaluation_failed;
    result.message = fmt::format("{}; {}", result.message, guarded.failure());
  }
  if (result.z.size() == 0) {
    result.z = problem.best().z.size() > 0 ? problem.best().z : z_guess;
    result.dual_violation = problem.best().dual_violation;
  }
  if (guarded.broken()) {
    result.cost = result.constraint_violation = std::numeric_limits<double>::quiet_NaN();
  } else {
    remeasure_result(nlp, options.tolerance, name(), result);
  }
  result.times = guarded.times();
  result.times.cpu = cpu_seconds() - cpu_began;
  result.seconds = wall_seconds() - began;
  return result;
}

}  // namespace prowl

/// What load_solver() looks for; the caller owns the result.
extern "C" [[gnu::visibility("default")]] prowl::NlpSolver* prowl_make_solver(const char* /*name*/) {
  return new prowl::UnoSolver();
}

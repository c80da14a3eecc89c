#include "prowl/solvers/foreign/ipopt_solver.hpp"

#include <IpLinearSolvers.h>
#include <IpStdCInterface.h>
#include <IpoptConfig.h>
#include <dlfcn.h>
#include <fmt/format.h>

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>

#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/iterate.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solvers/arguments.hpp"
#include "prowl/solvers/foreign/library_release.hpp"
#include "prowl/solvers/guarded_nlp.hpp"
#include "prowl/solvers/remeasure_result.hpp"
#include "prowl/solvers/thrown_error.hpp"

// MUMPS calls OpenBLAS, whose sums depend on the number of threads. Weak: other BLAS libraries lack
// it.
extern "C" void openblas_set_num_threads(int) __attribute__((weak));

// Ipopt 3.14 has the first of these, 3.14.18 both. Weak: if LD_LIBRARY_PATH loads another
// libipopt.so, the error should name that library, not a missing symbol.
#pragma weak IpoptGetAvailableLinearSolvers
#pragma weak GetIpoptVersion

namespace prowl {
namespace {

using Eigen::VectorXd;
using Ipopt::Index;
using Ipopt::Number;
using VectorMap = Eigen::Map<VectorXd>;
using ConstVectorMap = Eigen::Map<const VectorXd>;

struct Iterate : IterateFigures {
  VectorXd z, multipliers;
};

/// Adapter from Ipopt to the Nlp.
class IpoptProblem : public Ipopt::TNLP {
 public:
  IpoptProblem(GuardedNlp& guarded, const VectorXd& z_guess, const SolverOptions& options, double began)
      : guarded_(guarded), nlp_(guarded.nlp()), options_(options), began_(began), z_guess_(z_guess) {}

  const Iterate& best() const { return best_; }
  const Iterate& last() const { return last_; }
  int iterations() const { return iterations_; }

  bool get_nlp_info(Index& n, Index& m, Index& nnz_jac_g, Index& nnz_h_lag, IndexStyleEnum& index_style) override {
    n = nlp_.num_variables();
    m = nlp_.num_constraints();
    nnz_jac_g = nlp_.jacobian_pattern().size();
    nnz_h_lag = nlp_.hessian_pattern().size();
    index_style = C_STYLE;
    return true;
  }

  bool get_bounds_info(Index n, Number* z_lower, Number* z_upper, Index m, Number* g_lower, Number* g_upper) override {
    VectorMap(z_lower, n) = nlp_.variable_lower();
    VectorMap(z_upper, n) = nlp_.variable_upper();
    VectorMap(g_lower, m) = nlp_.constraint_lower();
    VectorMap(g_upper, m) = nlp_.constraint_upper();
    return true;
  }

  bool get_starting_point(Index n, bool, Number* z, bool, Number*, Number*, Index, bool, Number*) override {
    VectorMap(z, n) = z_guess_;  // no multipliers: warm_start_init_point is off
    return true;
  }

  bool eval_f(Index n, const Number* z, bool, Number& value) override { return guarded_.cost(point(z, n), value); }

  bool eval_grad_f(Index n, const Number* z, bool, Number* gradient) override {
    return guarded_.cost_gradient(point(z, n), VectorMap(gradient, n));
  }

  bool eval_g(Index n, const Number* z, bool, Index m, Number* g) override {
    return guarded_.constraints(point(z, n), VectorMap(g, m));
  }

  bool eval_jac_g(Index n, const Number* z, bool, Index, Index size, Index* rows, Index* cols,
                  Number* values) override {
    if (!values) return copy_pattern(nlp_.jacobian_pattern(), rows, cols);
    return guarded_.jacobian(point(z, n), VectorMap(values, size));
  }

  bool eval_h(Index n, const Number* z, bool, Number cost_factor, Index m, const Number* multipliers, bool, Index size,
              Index* rows, Index* cols, Number* values) override {
    if (!values) return copy_pattern(nlp_.hessian_pattern(), rows, cols);
    return guarded_.hessian(point(z, n), cost_factor, ConstVectorMap(multipliers, m), VectorMap(values, size));
  }

  bool intermediate_callback(Ipopt::AlgorithmMode mode, Index iteration, Number cost, Number, Number inf_du, Number,
                             Number, Number, Number, Number, Index, const Ipopt::IpoptData* data,
                             Ipopt::IpoptCalculatedQuantities* quantities) override {
    iterations_ = iteration;
    read_iterate(mode, cost, inf_du, data, quantities);
    if (options_.on_iteration) {
      options_.on_iteration({iteration, last_.cost, last_.violation, last_.dual_violation, wall_seconds() - began_});
    }
    if (options_.on_iterate && last_.z.size() > 0) options_.on_iterate(last_.z);
    guarded_.forget_failure();  // resolved by a shorter step
    return !guarded_.broken() && !(options_.interrupt && options_.interrupt->load());
  }

  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* z, const Number*, const Number*, Index m,
                         const Number*, const Number* multipliers, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    last_.z = ConstVectorMap(z, n);  // within the bounds, unlike the iterate: honor_original_bounds
    last_.multipliers = ConstVectorMap(multipliers, m);
  }

 private:
  const VectorXd& point(const Number* z, Index n) {
    z_ = ConstVectorMap(z, n);
    return z_;
  }

  static bool copy_pattern(const SparsityPattern& pattern, Index* rows, Index* cols) {
    std::copy(pattern.rows.begin(), pattern.rows.end(), rows);
    std::copy(pattern.cols.begin(), pattern.cols.end(), cols);
    return true;
  }

  /// Variables and constraints of the original problem, also during restoration.
  void read_iterate(Ipopt::AlgorithmMode mode, Number cost, Number inf_du, const Ipopt::IpoptData* data,
                    Ipopt::IpoptCalculatedQuantities* quantities) {
    const int n = nlp_.num_variables();
    const int m = nlp_.num_constraints();
    Iterate now{{}, VectorXd(n), VectorXd(m)};
    VectorXd g(m);
    if (!get_curr_iterate(data, quantities, false, n, now.z.data(), nullptr, nullptr, m, g.data(),
                          now.multipliers.data())) {
      return;
    }
    now.violation = constraint_violation(nlp_, now.z, g);
    now.dual_violation = inf_du;
    if (mode == Ipopt::RestorationPhaseMode) {  // cost and inf_du belong to the restoration problem
      guarded_.cost(now.z, now.cost);
    } else {
      now.cost = cost;
      VectorXd gradient(n);
      if (get_curr_violations(data, quantities, false, n, nullptr, nullptr, nullptr, nullptr, gradient.data(), m,
                              nullptr, nullptr)) {
        now.dual_violation = gradient.lpNorm<Eigen::Infinity>();
      }
    }
    if (is_better(now, best_, options_.tolerance)) best_ = now;
    last_ = std::move(now);
  }

  GuardedNlp& guarded_;
  const Nlp& nlp_;
  const SolverOptions& options_;
  double began_;
  const VectorXd z_guess_;
  VectorXd z_;
  Iterate best_, last_;
  int iterations_ = 0;
};

struct Outcome {
  SolveStatus status;
  const char* words;
};

Outcome outcome(Ipopt::ApplicationReturnStatus code) {
  using enum SolveStatus;
  switch (code) {
    case Ipopt::Solve_Succeeded: return {converged, "optimal within tolerance"};
    case Ipopt::Solved_To_Acceptable_Level: return {solver_failed, "stopped at a point that is not within tolerance"};
    case Ipopt::Infeasible_Problem_Detected:
      return {infeasible, "converged to a local minimum of the constraint violation"};
    case Ipopt::Search_Direction_Becomes_Too_Small: return {solver_failed, "search direction became too small"};
    case Ipopt::Diverging_Iterates: return {solver_failed, "iterates diverge: the cost may have no lower bound"};
    case Ipopt::User_Requested_Stop: return {interrupted, "stopped on request"};
    case Ipopt::Feasible_Point_Found: return {solver_failed, "feasible, but not shown to be optimal"};
    case Ipopt::Maximum_Iterations_Exceeded: return {iteration_limit, "iteration limit reached"};
    case Ipopt::Restoration_Failed: return {solver_failed, "restoration phase failed to reduce the violation"};
    case Ipopt::Error_In_Step_Computation: return {solver_failed, "no search direction could be computed"};
    case Ipopt::Maximum_CpuTime_Exceeded:
    case Ipopt::Maximum_WallTime_Exceeded: return {time_limit, "time limit reached"};
    case Ipopt::Not_Enough_Degrees_Of_Freedom: return {solver_failed, "more equality constraints than free variables"};
    case Ipopt::Invalid_Problem_Definition: return {solver_failed, "problem definition is not valid"};
    case Ipopt::Invalid_Option: return {solver_failed, "an option of Ipopt is not valid"};
    case Ipopt::Invalid_Number_Detected: return {evaluation_failed, "an evaluation failed"};
    case Ipopt::Insufficient_Memory: return {solver_failed, "out of memory"};
    default: return {solver_failed, "internal error in Ipopt"};
  }
}

void set_options(Ipopt::OptionsList& list, const SolverOptions& options) {
  list.SetStringValue("sb", "yes");
  list.SetIntegerValue("print_level", 0);
  list.SetStringValue("hessian_approximation", "exact");
  list.SetNumericValue("tol", options.tolerance);
  // Tighter than remeasure_result(): Ipopt checks before it moves the variables back into the
  // original bounds.
  list.SetNumericValue("constr_viol_tol", 0.9 * options.tolerance);
  // `tol` refers to the scaled problem, these two to the original one; their defaults are loose.
  list.SetNumericValue("dual_inf_tol", options.tolerance);
  list.SetNumericValue("compl_inf_tol", options.tolerance);
  list.SetIntegerValue("acceptable_iter", 0);
  list.SetIntegerValue("max_iter", options.max_iterations);
  list.SetNumericValue("max_wall_time", options.max_seconds);
  // Ipopt relaxes all bounds slightly to obtain an interior: here far less than the tolerance. The
  // result is moved back.
  list.SetNumericValue("bound_relax_factor", 0.01 * options.tolerance);
  list.SetStringValue("honor_original_bounds", "yes");
  // Prowl's rows and costs are of order one and its guesses nearly feasible. Ipopt's default 0.1
  // moves the first iterates so far that the curvature of the dynamics makes the Hessian indefinite
  // (Solo12: 300 iterations, with this value 15). Near a solution a larger mu costs iterations, and
  // active variables may start close to their bounds.
  list.SetNumericValue("mu_init", options.is_warm_start ? 1e-5 : 1e-3);
  if (options.is_warm_start) {
    for (const char* push : {"bound_push", "bound_frac", "slack_bound_push", "slack_bound_frac"}) {
      list.SetNumericValue(push, 1e-4);
    }
    list.SetStringValue("bound_mult_init_method", "mu-based");
  }
  // Re-estimate the multipliers when the constraints nearly hold. A regularised step that removes a
  // violation makes them grow with the regularisation, which distorts the next Hessian (HyQ trot,
  // 83 intervals: not solved in 300 iterations, with this option solved in 231).
  list.SetStringValue("recalc_y", "yes");
  list.SetNumericValue("recalc_y_feas_tol", 1e-2);
}

void set_linear_solver(Ipopt::OptionsList& list, IpoptLinearSolver linear_solver) {
  if (linear_solver == IpoptLinearSolver::spral) {
    list.SetStringValue("linear_solver", "spral");
    // By default SPRAL scales and orders by a new matching each time, which takes longer than the
    // factorisation (HyQ stand, 40 intervals: 2.3 s of CPU time instead of 0.7 s).
    list.SetStringValue("spral_order", "metis");
    list.SetStringValue("spral_scaling", "ruiz");
    // Fewer columns per front than the default 32: stages have about 50 variables, few of them
    // free.
    list.SetIntegerValue("spral_nemin", 8);
    return;
  }
  list.SetStringValue("linear_solver", "mumps");
  // Approximate minimum fill, built into MUMPS. METIS orderings differ between builds.
  list.SetIntegerValue("mumps_pivot_order", 2);
  // Iterative row and column scaling. The default permutes by a matching first; the many delayed
  // pivots then cause wrong inertias (HyQ balance, 120 intervals: 57 iterations of 0.6 s, with this
  // option 23 of 0.3 s).
  list.SetIntegerValue("mumps_scaling", 7);
}

/// Version of the loaded library, which may differ from the one of the build.
std::string loaded_version() {
  if (!IpoptGetAvailableLinearSolvers) return "before 3.14";
  if (!GetIpoptVersion) return "3.14";
  int major = 0, minor = 0, release = 0;
  GetIpoptVersion(&major, &minor, &release);
  return fmt::format("{}.{}.{}", major, minor, release);
}

std::string loaded_file() {
  Dl_info info = {};
  const bool is_known = GetIpoptVersion && ::dladdr(reinterpret_cast<void*>(&GetIpoptVersion), &info) != 0;
  return is_known && info.dli_fname ? info.dli_fname : "libipopt.so";
}

/// Why the loaded Ipopt lacks a linear solver: builds differ.
std::optional<std::string> why_missing(IpoptLinearSolver linear_solver) {
  if (auto reason = IpoptSolver::why_wrong_library()) return reason;
  const bool spral = linear_solver == IpoptLinearSolver::spral;
  const unsigned built_in =
      IpoptGetAvailableLinearSolvers(true);  // NOLINT(clang-analyzer-core.CallAndMessage): checked above
  if (built_in & (spral ? IPOPTLINEARSOLVER_SPRAL : IPOPTLINEARSOLVER_MUMPS)) return std::nullopt;
  return fmt::format(
      "the loaded libipopt.so was built without {}; the pinned casadi wheel contains one with it (scripts/setup)",
      spral ? "SPRAL" : "MUMPS");
}

void run_ipopt(GuardedNlp& guarded, const VectorXd& z_guess, const SolverOptions& options,
               IpoptLinearSolver linear_solver, double began, SolveResult& result) {
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> ipopt = new Ipopt::IpoptApplication(false);  // prints nothing
  set_options(*ipopt->Options(), options);
  set_linear_solver(*ipopt->Options(), linear_solver);
  if (openblas_set_num_threads) openblas_set_num_threads(1);

  auto* problem = new IpoptProblem(guarded, z_guess, options, began);
  const Ipopt::SmartPtr<Ipopt::TNLP> owner = problem;
  Ipopt::ApplicationReturnStatus code = ipopt->Initialize("");  // "": no ipopt.opt from the working directory
  if (code == Ipopt::Solve_Succeeded) code = ipopt->OptimizeTNLP(owner);

  const auto [status, words] = outcome(code);
  result.status = status;
  result.message = words;
  result.iterations = problem->iterations();
  const bool gave_up = status == SolveStatus::solver_failed || status == SolveStatus::evaluation_failed;
  if (guarded.broken()) {
    result.status = SolveStatus::solver_failed;
    result.message = guarded.failure();
  } else if (gave_up && !guarded.failure().empty()) {
    result.status = SolveStatus::evaluation_failed;
    result.message = fmt::format("{}; {}", words, guarded.failure());
  }

  const bool finished = status == SolveStatus::converged || status == SolveStatus::infeasible;
  const Iterate& chosen = finished ? problem->last() : problem->best();
  if (chosen.z.size() == 0) return;  // failed before the first iterate
  result.z = chosen.z;
  result.multipliers = chosen.multipliers;
  result.dual_violation = chosen.dual_violation;
}

}  // namespace

std::string IpoptSolver::name() const { return linear_solver_ == IpoptLinearSolver::spral ? "Ipopt-SPRAL" : "Ipopt"; }

std::string IpoptSolver::version() const { return loaded_version(); }

std::optional<std::string> IpoptSolver::why_wrong_library() {
  return why_other_release("Ipopt", loaded_version(), IPOPT_VERSION, loaded_file());
}

std::optional<std::string> IpoptSolver::why_unsupported(Nlp& nlp) const {
  if (auto reason = why_missing(linear_solver_)) return reason;
  return why_nothing_left(nlp);
}

SolveResult IpoptSolver::solve(Nlp& nlp, const VectorXd& z_guess, const SolverOptions& options) const {
  check_arguments(nlp, z_guess, options);
  nlp.use_threads(options.threads);
  const double began = wall_seconds();
  const double cpu_began = cpu_seconds();
  GuardedNlp guarded(nlp);
  SolveResult result;
  result.z = z_guess;
  result.cost = result.constraint_violation = std::numeric_limits<double>::quiet_NaN();
  if (const auto missing = why_missing(linear_solver_)) {
    result.message = *missing;
  } else if (guarded.finite_point(z_guess)) {
    try {
      run_ipopt(guarded, z_guess, options, linear_solver_, began, result);
    } catch (...) {
      result.status = SolveStatus::solver_failed;
      result.message = "Ipopt: " + thrown_error();
    }
  } else {
    result.status = SolveStatus::evaluation_failed;
    result.message = fmt::format("start: {}", guarded.failure());
  }
  if (!guarded.broken()) remeasure_result(nlp, options.tolerance, name(), result);
  result.times = guarded.times();
  result.times.cpu = cpu_seconds() - cpu_began;
  result.seconds = wall_seconds() - began;
  return result;
}

}  // namespace prowl

/// What load_solver() looks for; the caller owns the result.
extern "C" [[gnu::visibility("default")]] prowl::NlpSolver* prowl_make_solver(const char* name) {
  const bool spral = std::string_view(name) == "ipopt-spral";
  return new prowl::IpoptSolver(spral ? prowl::IpoptLinearSolver::spral : prowl::IpoptLinearSolver::mumps);
}

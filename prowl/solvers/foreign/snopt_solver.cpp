#include "prowl/solvers/foreign/snopt_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <limits>
#include <mutex>
#include <vector>

#include "prowl/error.hpp"
#include "prowl/nlp/constraint_violation.hpp"
#include "prowl/nlp/dual_violation.hpp"
#include "prowl/nlp/iterate.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solvers/arguments.hpp"
#include "prowl/solvers/foreign/snopt_library.hpp"
#include "prowl/solvers/guarded_nlp.hpp"
#include "prowl/solvers/remeasure_result.hpp"
#include "prowl/solvers/thrown_error.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;
using std::vector;

/// Adapter from SNOPT to the Nlp. Row 0 is the cost; derivatives are its gradient, then the
/// Jacobian's values.
class SnoptProblem {
 public:
  SnoptProblem(GuardedNlp& guarded, const SolverOptions& options, double began)
      : guarded_(guarded), nlp_(guarded.nlp()), options_(options), began_(began), rows_(nlp_.num_constraints()) {}

  const VectorXd& best() const { return best_z_; }  ///< empty if nothing was evaluated
  std::optional<SolveStatus> why_stopped() const { return why_stopped_; }
  const std::string& mistake() const {
    return mistake_;
  }  ///< message of an exception, not passed through Fortran; else empty

  static void callback(int* status, int* n, double x[], int* need_values, int*, double values[], int* need_derivatives,
                       int*, double derivatives[], char[], int*, int iu[], int*, double[], int*) {
    SnoptProblem* self = nullptr;
    std::memcpy(static_cast<void*>(&self), iu,
                sizeof(SnoptProblem*));  // the only data that the interface passes through
    try {
      const VectorXd z = Eigen::Map<VectorXd>(x, *n);
      if (self->should_stop())
        *status = -2;
      else if (!self->evaluate(z, *need_values > 0 ? values : nullptr, *need_derivatives > 0 ? derivatives : nullptr)) {
        *status = self->guarded_.broken() ? -2 : -1;
      }
    } catch (...) {
      self->mistake_ = thrown_error();
      *status = -2;
    }
  }

 private:
  bool should_stop() {
    if (options_.interrupt && options_.interrupt->load())
      why_stopped_ = SolveStatus::interrupted;
    else if (wall_seconds() - began_ > options_.max_seconds)
      why_stopped_ = SolveStatus::time_limit;
    return why_stopped_.has_value();
  }

  bool evaluate(const VectorXd& z, double* values, double* derivatives) {
    if (values) {
      if (!guarded_.cost(z, values[0]) || !guarded_.constraints(z, rows_)) return false;
      Eigen::Map<VectorXd>(values + 1, rows_.size()) = rows_;
      tell(z, values[0]);
    }
    return !derivatives ||
           (guarded_.cost_gradient(z, Eigen::Map<VectorXd>(derivatives, z.size())) &&
            guarded_.jacobian(z, Eigen::Map<VectorXd>(derivatives + z.size(), nlp_.jacobian_pattern().size())));
  }

  void tell(const VectorXd& z, double cost) {
    guarded_.forget_failure();  // resolved by a shorter step
    const IterateFigures now{cost, constraint_violation(nlp_, z, rows_), 0.0};
    if (options_.on_iteration) {
      options_.on_iteration({evaluations_, now.cost, now.violation, 0.0, wall_seconds() - began_});
    }
    if (options_.on_iterate) options_.on_iterate(z);
    ++evaluations_;
    if (!is_better(now, best_, options_.tolerance)) return;
    best_ = now;
    best_z_ = z;
  }

  GuardedNlp& guarded_;
  const Nlp& nlp_;
  const SolverOptions& options_;
  double began_;
  VectorXd rows_, best_z_;
  IterateFigures best_;
  int evaluations_ = 0;
  std::optional<SolveStatus> why_stopped_;
  std::string mistake_;
};

template <class T>
int size(const vector<T>& values) {
  return static_cast<int>(values.size());
}

/// SNOPT's work space, including its options; freed by `end`.
class Workspace {
 public:
  explicit Workspace(const SnoptLibrary& library) : library_(library), integers_(kLeast), reals_(kLeast) {
    library_.initialise(iw(), leniw(), rw(), lenrw());
  }
  ~Workspace() { library_.end(iw(), leniw(), rw(), lenrw()); }
  Workspace(const Workspace&) = delete;
  Workspace& operator=(const Workspace&) = delete;

  void set(const std::string& option) {
    int errors = 0;
    library_.set(option.c_str(), static_cast<int>(option.size()), &errors, iw(), leniw(), rw(), lenrw());
    if (errors != 0) throw InputError(fmt::format("SNOPT does not know the option \"{}\"", option));
  }

  /// Twice SNOPT's estimate, which ignores the fill of its factors.
  void resize_for(int num_rows, int n, int num_derivatives) {
    int info = 0, num_integers = 0, num_reals = 0;
    library_.needed_memory(&info, num_rows, n, 0, num_derivatives, &num_integers, &num_reals, iw(), leniw(), rw(),
                           lenrw());
    integers_.resize(2 * static_cast<std::size_t>(std::max(num_integers, kLeast)));
    reals_.resize(2 * static_cast<std::size_t>(std::max(num_reals, kLeast)));
    set(fmt::format("Total integer workspace {}", leniw()));
    set(fmt::format("Total real workspace {}", lenrw()));
  }

  int major_iterations() const { return integers_[421]; }  // iw(422) of SNOPT 7

  int* iw() { return integers_.data(); }
  double* rw() { return reals_.data(); }
  int leniw() const { return size(integers_); }
  int lenrw() const { return size(reals_); }

 private:
  static constexpr int kLeast = 500;  // minimum of each, enough for the options
  const SnoptLibrary& library_;
  vector<int> integers_;
  vector<double> reals_;
};

struct Outcome {
  SolveStatus status;
  const char* words;
};

/// SNOPT's INFO by tens (User's Guide 7.4, section 8.6), with exceptions.
Outcome outcome(int info) {
  using enum SolveStatus;
  if (info == 1) return {converged, "optimality conditions satisfied"};
  if (info == 31) return {iteration_limit, "limit of minor iterations reached"};
  if (info == 32) return {iteration_limit, "iteration limit reached"};
  if (info == 33) return {solver_failed, "the superbasics limit is too small"};
  if (info == 34) return {time_limit, "time limit reached"};
  switch (info / 10) {
    case 0: return {solver_failed, "stopped at a point that is not optimal within tolerance"};
    case 1: return {infeasible, "converged to a local minimum of the constraint violation"};
    case 2: return {solver_failed, "the cost may have no lower bound"};
    case 4: return {solver_failed, "numerical difficulties"};
    case 5: return {solver_failed, "derivatives seem to be wrong"};
    case 6: return {evaluation_failed, "an evaluation failed"};
    case 7: return {solver_failed, "stopped by an evaluation"};
    case 8: return {solver_failed, "not enough work space"};
    default: return {solver_failed, "SNOPT failed"};
  }
}

/// Bounds for SNOPT, where 1e20 is infinite.
vector<double> bounds(const VectorXd& values, bool with_cost, double of_cost) {
  constexpr double kInfinite = 1e20;
  vector<double> all;
  if (with_cost) all.push_back(of_cost * kInfinite);
  for (const double value : values) all.push_back(std::clamp(value, -kInfinite, kInfinite));
  return all;
}

void set_options(Workspace& work, const VectorXd& z_guess, const SolverOptions& options) {
  work.set(fmt::format("Major iterations limit {}", options.max_iterations));
  work.set("Iterations limit 1000000");  // minor iterations; the user limits major ones
  work.set(fmt::format("Major optimality tolerance {:.3e}", options.tolerance));
  work.set(fmt::format("Major feasibility tolerance {:.3e}", options.tolerance / std::max(1.0, z_guess.norm())));
  work.set(fmt::format("Superbasics limit {}", z_guess.size() + 1));
  constexpr int kMostForFullMemory = 500;  // reason: python/prowl/snopt.py, with the same options
  work.set(z_guess.size() <= kMostForFullMemory ? "Hessian full memory" : "Hessian limited memory");
  work.set("Derivative option 1");
  work.set("Verify level -1");
}

/// Input and output arrays of SNOPT.
struct Point {
  Point(const Nlp& nlp, const VectorXd& z_guess)
      : x(z_guess.begin(), z_guess.end()), row_multipliers(1 + static_cast<std::size_t>(nlp.num_constraints()), 0.0) {}
  vector<double> x, row_multipliers;
};

/// Runs SNOPT and returns its INFO.
int call(const SnoptLibrary& library, const Nlp& nlp, SnoptProblem& problem, Workspace& work, Point& point) {
  const int n = nlp.num_variables(), num_rows = 1 + nlp.num_constraints();
  vector<int> row(static_cast<std::size_t>(n), 1), col;  // counted from 1, as in Fortran
  for (int i = 0; i < n; ++i) col.push_back(i + 1);
  for (const int i : nlp.jacobian_pattern().rows) row.push_back(i + 2);
  for (const int j : nlp.jacobian_pattern().cols) col.push_back(j + 1);
  work.resize_for(num_rows, n, size(row));

  vector<double> lower = bounds(nlp.variable_lower(), false, 0.0), upper = bounds(nlp.variable_upper(), false, 0.0);
  vector<double> row_lower = bounds(nlp.constraint_lower(), true, -1.0),
                 row_upper = bounds(nlp.constraint_upper(), true, 1.0);
  vector<double> values(static_cast<std::size_t>(num_rows), 0.0), x_multipliers(point.x.size(), 0.0);
  vector<int> x_state(point.x.size(), 0), row_state(values.size(), 0);
  SnoptProblem* const self = &problem;
  int user[sizeof(SnoptProblem*) / sizeof(int)];
  std::memcpy(user, static_cast<const void*>(&self), sizeof(SnoptProblem*));
  int no_index = 0, info = 0, num_superbasics = 0, num_infeasible = 0, integers = 0, reals = 0;
  double no_number = 0.0, sum_infeasible = 0.0;
  constexpr int kCold = 0, kCostRow = 1, kNoneLinear = 0;
  library.solve(kCold, "prowl", num_rows, n, 0.0, kCostRow, &SnoptProblem::callback, &no_index, &no_index, kNoneLinear,
                &no_number, row.data(), col.data(), size(row), lower.data(), upper.data(), row_lower.data(),
                row_upper.data(), point.x.data(), x_state.data(), x_multipliers.data(), values.data(), row_state.data(),
                point.row_multipliers.data(), &info, &num_superbasics, &num_infeasible, &sum_infeasible, &integers,
                &reals, user, std::ssize(user), &no_number, 1, work.iw(), work.leniw(), work.rw(), work.lenrw());
  return info;
}

}  // namespace

SnoptSolver::SnoptSolver(const std::string& library) : library_(std::make_unique<SnoptLibrary>(library)) {}
SnoptSolver::~SnoptSolver() = default;

const std::optional<std::string>& SnoptSolver::why_unavailable() const { return library_->why_unusable(); }

std::string SnoptSolver::name() const { return "SNOPT"; }

std::string SnoptSolver::version() const { return "7"; }

std::optional<std::string> SnoptSolver::why_unsupported(Nlp& nlp) const {
  return why_unavailable() ? why_unavailable() : why_nothing_left(nlp);
}

SolveResult SnoptSolver::solve(Nlp& nlp, const VectorXd& z_guess, const SolverOptions& options) const {
  check_arguments(nlp, z_guess, options);
  if (why_unavailable()) throw InputError(*why_unavailable());
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  nlp.use_threads(options.threads);
  const double began = wall_seconds(), cpu_began = cpu_seconds();
  GuardedNlp guarded(nlp);
  SnoptProblem problem(guarded, options, began);

  Workspace work(*library_);
  set_options(work, z_guess, options);
  Point point(nlp, z_guess);
  const int info = call(*library_, nlp, problem, work, point);

  const auto [status, words] = outcome(info);
  SolveResult result;
  result.status = problem.why_stopped().value_or(status);
  result.message = fmt::format("{} (SNOPT INFO {})", words, info);
  if (guarded.broken()) result.status = SolveStatus::solver_failed;
  if (!problem.mistake().empty()) {
    result.status = SolveStatus::solver_failed;
    result.message = problem.mistake();
  }
  if (!guarded.failure().empty() && !problem.why_stopped()) result.message += "; " + guarded.failure();
  result.iterations = work.major_iterations();
  if (result.status == SolveStatus::converged || result.status == SolveStatus::infeasible) {
    result.z = Eigen::Map<VectorXd>(point.x.data(), z_guess.size());
    result.multipliers =
        -Eigen::Map<VectorXd>(point.row_multipliers.data() + 1, nlp.num_constraints());  // SNOPT's: f − π . g
  } else {
    result.z = problem.best().size() > 0 ? problem.best() : z_guess;
  }
  if (guarded.broken()) {
    result.cost = result.constraint_violation = std::numeric_limits<double>::quiet_NaN();
  } else {
    remeasure_result(nlp, options.tolerance, "SNOPT", result);
  }
  if (result.status == SolveStatus::converged)
    result.dual_violation = dual_violation(nlp, result.z, result.multipliers);
  result.times = guarded.times();
  result.times.cpu = cpu_seconds() - cpu_began;
  result.seconds = wall_seconds() - began;
  return result;
}

}  // namespace prowl

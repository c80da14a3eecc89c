#include "prowl/solvers/foreign/fatrop_solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fatrop/fatrop.hpp>
#include <fatrop/ip_algorithm/ip_eq_mult_initializer.hpp>
#include <fatrop/ip_algorithm/ip_nlp_orig.hpp>
#include <functional>
#include <limits>
#include <utility>

extern "C" {  // the header lacks this
#include <blasfeo_processor_features.h>
}

#include "prowl/error.hpp"
#include "prowl/nlp/iterate.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solvers/arguments.hpp"
#include "prowl/solvers/foreign/library_release.hpp"
#include "prowl/solvers/remeasure_result.hpp"
#include "prowl/solvers/thrown_error.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using fatrop::Index;
using fatrop::Scalar;
using fatrop::VecRealView;
using Type = fatrop::OcpType;
using Info = fatrop::ProblemInfo<Type>;
using Dims = fatrop::ProblemDims<Type>;

constexpr double kNearlyFeasible = 1e-2;  // as recalc_y_feas_tol in IpoptSolver
constexpr double kLargestMultiplier = 1e6;

/// Thrown through Fatrop, the only way to stop it.
struct Stopped {
  SolveStatus status;
  std::string message;
};

struct Iterate : IterateFigures {
  std::vector<VectorXd> stages;
};

Dims dims_of(const StagewiseNlp& nlp) {
  std::vector<Index> inputs, states, equalities, inequalities;
  for (int k = 0; k < nlp.num_stages(); ++k) {
    inputs.push_back(nlp.size(k).inputs);
    states.push_back(nlp.size(k).states);
    equalities.push_back(nlp.size(k).equalities);
    inequalities.push_back(nlp.size(k).inequalities);
  }
  return {nlp.num_stages(), inputs, states, equalities, inequalities};
}

fatrop::NlpDims totals(const Dims& dims) {
  fatrop::NlpDims sum(0, 0, 0);
  for (int k = 0; k < dims.K; ++k) {
    sum.number_of_variables += dims.number_of_controls[k] + dims.number_of_states[k];
    sum.number_of_eq_constraints += dims.number_of_eq_constraints[k] + dims.number_of_ineq_constraints[k];
    if (k > 0) sum.number_of_eq_constraints += dims.number_of_states[k];
    sum.number_of_ineq_constraints += dims.number_of_ineq_constraints[k];
  }
  sum.number_of_tangent_variables = sum.number_of_variables;
  return sum;
}

/// Fatrop's matrices have one row per variable, one column per function, and one extra row for its
/// own use.
void copy_transposed(const MatrixXd& from, blasfeo_dmat& to) {
  if (from.size() == 0) return;
  blasfeo_pack_tran_dmat(static_cast<int>(from.rows()), static_cast<int>(from.cols()), const_cast<double*>(from.data()),
                         static_cast<int>(from.rows()), &to, 0, 0);
}

Eigen::Map<VectorXd> segment(const VecRealView& vector, Index first, Eigen::Index size) {
  return {size > 0 ? const_cast<Scalar*>(vector.data()) + first : nullptr, size};
}

/// Adapter from Fatrop to the stages. Variables: (u_0, x_0, u_1, x_1 ...); multipliers: of
/// dynamics, equalities, inequalities, in this order.
class FatropProblem : public fatrop::Nlp<Type> {
 public:
  FatropProblem(StagewiseNlp& nlp, std::vector<VectorXd> guess, const SolverOptions& options, double began)
      : nlp_(nlp),
        options_(options),
        began_(began),
        dims_(dims_of(nlp)),
        totals_(totals(dims_)),
        guess_(std::move(guess)) {}

  const Iterate& best() const { return best_; }
  const std::string& failure() const { return failure_; }
  int iterations() const { return iterations_; }
  const SolveTimes& times() const { return times_; }

  const fatrop::NlpDims& nlp_dims() const override { return totals_; }
  const Dims& problem_dims() const override { return dims_; }

  Index eval_objective(const Info& info, const Scalar scale, const VecRealView& x, const VecRealView&,
                       Scalar& result) override {
    result = 0.0;
    const bool good = try_stages("cost", times_.values, [&](int k) {
      result += scale * nlp_.values(k, stage(info, x, k)).cost;
      return std::isfinite(result);
    });
    need(good || has_begun());
    if (!good) result = std::numeric_limits<double>::quiet_NaN();  // makes Fatrop shorten its step
    return 0;
  }

  Index eval_constraint_violation(const Info& info, const VecRealView& x, const VecRealView& slacks,
                                  VecRealView& result) override {
    check_limits();
    const bool good = try_stages("constraint", times_.values, [&](int k) {
      const StageValues& values = nlp_.values(k, stage(info, x, k));
      const StageSize& size = nlp_.size(k);
      segment(result, info.offsets_g_eq_path[k], size.equalities) = values.equalities;
      segment(result, info.offsets_g_eq_slack[k], size.inequalities) =
          values.inequalities - segment(slacks, info.offsets_slack[k], size.inequalities);
      if (k + 1 < dims_.K) {
        segment(result, info.offsets_g_eq_dyn[k], values.next.size()) =
            values.next - segment(x, info.offsets_primal_x[k + 1], values.next.size());
      }
      return values.equalities.allFinite() && values.inequalities.allFinite() && values.next.allFinite();
    });
    need(good || has_begun());
    if (!good) result = std::numeric_limits<double>::quiet_NaN();
    return 0;
  }

  Index eval_objective_gradient(const Info& info, const Scalar scale, const VecRealView& x, const VecRealView&,
                                VecRealView& gradient_x, VecRealView& gradient_s) override {
    gradient_s = 0.0;
    need(try_stages("cost gradient", times_.derivatives, [&](int k) {
      const VectorXd& gradient = nlp_.derivatives(k, stage(info, x, k)).cost_gradient;
      segment(gradient_x, info.offsets_primal_u[k], gradient.size()) = scale * gradient;
      return gradient.allFinite();
    }));
    return 0;
  }

  Index eval_constr_jac(const Info& info, const VecRealView& x, const VecRealView&,
                        fatrop::Jacobian<Type>& jacobian) override {
    need(try_stages("constraint Jacobian", times_.derivatives, [&](int k) {
      const StageDerivatives& slopes = nlp_.derivatives(k, stage(info, x, k));
      copy_transposed(slopes.equalities, jacobian.Gg_eqt[k].mat());
      copy_transposed(slopes.inequalities, jacobian.Gg_ineqt[k].mat());
      if (k + 1 < dims_.K) copy_transposed(slopes.next, jacobian.BAbt[k].mat());
      return slopes.equalities.allFinite() && slopes.inequalities.allFinite() && slopes.next.allFinite();
    }));
    return 0;
  }

  Index eval_lag_hess(const Info& info, const Scalar scale, const VecRealView& x, const VecRealView&,
                      const VecRealView& multipliers, fatrop::Hessian<Type>& hessian) override {
    need(try_stages("Hessian", times_.derivatives, [&](int k) {
      const StageSize& size = nlp_.size(k);
      const int next = k + 1 < dims_.K ? nlp_.size(k + 1).states : 0;
      on_.equalities = segment(multipliers, info.offsets_g_eq_path[k], size.equalities);
      on_.inequalities = segment(multipliers, info.offsets_g_eq_slack[k], size.inequalities);
      on_.next = segment(multipliers, next > 0 ? info.offsets_g_eq_dyn[k] : 0, next);
      const MatrixXd& values = nlp_.hessian(k, stage(info, x, k), scale, on_);
      copy_transposed(values, hessian.RSQrqt[k].mat());
      return values.allFinite();
    }));
    return 0;
  }

  Index get_bounds(const Info& info, VecRealView& lower, VecRealView& upper) override {
    for (int k = 0; k < dims_.K; ++k) {
      const Index first = info.offsets_slack[k];
      segment(lower, first, nlp_.lower(k).size()) = nlp_.lower(k);
      segment(upper, first, nlp_.upper(k).size()) = nlp_.upper(k);
    }
    return 0;
  }

  Index get_initial_primal(const Info& info, VecRealView& x) override {
    for (int k = 0; k < dims_.K; ++k) {
      const VectorXd& ux = guess_[k];
      segment(x, info.offsets_primal_u[k], ux.size()) = ux;
    }
    return 0;
  }

  void get_primal_damping(const Info&, VecRealView& damping) override { damping = 0.0; }

  void apply_jacobian_s_transpose(const Info& info, const VecRealView& multipliers, const Scalar alpha,
                                  const VecRealView& y, VecRealView& out) override {
    out = alpha * y;  // d(inequalities - s)/ds = -1
    out.block(info.number_of_slack_variables, 0) =
        out.block(info.number_of_slack_variables, 0) -
        multipliers.block(info.number_of_slack_variables, info.offset_g_eq_slack);
  }

  /// Callback that sets the equality multipliers of the current iterate to their least-squares
  /// estimate.
  void set_multiplier_estimate(std::function<void()> estimate) { estimate_multipliers_ = std::move(estimate); }

  /// Called once per iteration, except while Fatrop restores feasibility.
  void callback(const fatrop::IpData<Type>& data) override {
    // The iterate evaluates lazily; these values exist already.
    auto& iterate = const_cast<fatrop::IpData<Type>&>(data).current_iterate();
    iterations_ = data.iteration_number();
    note(iterate);
    if (options_.on_iteration) {
      options_.on_iteration({iterations_, last_.cost, last_.violation, last_.dual_violation, wall_seconds() - began_});
    }
    if (options_.on_iterate) options_.on_iterate(nlp_.flat(last_.stages));
    check_limits();
    if (iterations_ >= options_.max_iterations) throw Stopped{SolveStatus::iteration_limit, "iteration limit reached"};
    if (!std::isfinite(last_.cost) || !std::isfinite(last_.violation) || !std::isfinite(last_.dual_violation)) {
      const std::string reason = failure_.empty() ? "the iterate is not finite" : failure_;
      throw Stopped{SolveStatus::evaluation_failed, reason};  // Fatrop's linear solver would loop forever
    }
    failure_.clear();  // resolved by a shorter step
    refresh_multipliers(iterate);
  }

  /// Fatrop starts with bound multipliers of one, far too large for its barrier near a solution. As
  /// in IpoptSolver, a regularised step that removes a violation leaves multipliers proportional to
  /// the regularisation.
  void refresh_multipliers(fatrop::IpIterate<Type>& iterate) {
    const bool begins_near = iterations_ == 0 && options_.is_warm_start;
    if (begins_near) {
      iterate.set_dual_bounds_l(iterate.mu() / iterate.delta_lower());
      iterate.set_dual_bounds_u(iterate.mu() / iterate.delta_upper());
    }
    const bool was_regularised = iterate.step_info().inertia_correction_primal > 0.0;
    if (begins_near || (was_regularised && last_.violation < kNearlyFeasible)) estimate_multipliers_();
  }

  const Iterate& note(fatrop::IpIterate<Type>& iterate) {
    last_.stages.clear();
    for (int k = 0; k < dims_.K; ++k) last_.stages.push_back(stage(iterate.info(), iterate.primal_x(), k));
    last_.cost = iterate.obj_value() / iterate.objective_scale;
    last_.violation = iterate.constr_viol_inf();
    last_.dual_violation = iterate.dual_infeasibility_x_inf();
    if (is_better(last_, best_, options_.tolerance)) best_ = last_;
    return last_;
  }

 private:
  VectorXd stage(const Info& info, const VecRealView& x, int k) const {
    return segment(x, info.offsets_primal_u[k], nlp_.size(k).variables());
  }

  void check_limits() const {
    if (options_.interrupt && options_.interrupt->load()) throw Stopped{SolveStatus::interrupted, "stopped on request"};
    if (wall_seconds() - began_ > options_.max_seconds) throw Stopped{SolveStatus::time_limit, "time limit reached"};
  }

  /// True if the evaluation of a stage is usable; otherwise sets failure_.
  template <typename Evaluate>
  bool try_stage(const char* what, int k, Evaluate& evaluate) {
    try {
      if (evaluate(k)) return true;
      failure_ = fmt::format("{} is not finite at {}", what, nlp_.describe_stage(k));
    } catch (const NumericalError& error) {
      failure_ = fmt::format("{} at {}: {}", what, nlp_.describe_stage(k), error.what());
    } catch (const std::exception& error) {
      throw Stopped{SolveStatus::solver_failed,
                    fmt::format("{} at {} threw: {}", what, nlp_.describe_stage(k), error.what())};
    }
    return false;
  }

  template <typename Evaluate>
  bool try_stages(const char* what, double& seconds, Evaluate evaluate) {
    const Stopwatch stopwatch(seconds);
    bool good = true;
    for (int k = 0; good && k < dims_.K; ++k) good = try_stage(what, k, evaluate);
    return good;
  }

  /// For failures that Fatrop cannot recover from: derivatives, which it does not check, and values
  /// at the start.
  void need(bool good) const {
    if (!good) throw Stopped{SolveStatus::evaluation_failed, failure_};
  }
  bool has_begun() const { return !best_.stages.empty(); }

  StagewiseNlp& nlp_;
  const SolverOptions& options_;
  double began_;
  Dims dims_;
  fatrop::NlpDims totals_;
  std::vector<VectorXd> guess_;
  StageMultipliers on_;
  Iterate best_, last_;
  std::function<void()> estimate_multipliers_;
  std::string failure_;
  int iterations_ = 0;
  SolveTimes times_;
};

Stopped outcome(fatrop::IpSolverReturnFlag flag) {
  using enum SolveStatus;
  using Flag = fatrop::IpSolverReturnFlag;
  switch (flag) {
    case Flag::Success: return {converged, "optimal within tolerance"};
    case Flag::MaxIterExceeded: return {iteration_limit, "iteration limit reached"};
    case Flag::StopAtAcceptablePoint: return {solver_failed, "stopped at a point that is not within tolerance"};
    case Flag::LocalInfeasibility: return {infeasible, "converged to a local minimum of the constraint violation"};
    case Flag::LineSearchFailed: return {solver_failed, "line search failed and feasibility could not be restored"};
    case Flag::ErrorInStepComputation: return {solver_failed, "no search direction could be computed"};
    case Flag::Unknown: break;
  }
  return {solver_failed, "internal error in Fatrop"};
}

void set_options(fatrop::OptionRegistry& registry, const SolverOptions& options) {
  registry.set_option("print_level", 0);
  registry.set_option("tolerance", options.tolerance);
  registry.set_option("constr_viol_tol", options.tolerance);
  registry.set_option("max_iter", options.max_iterations + 1);  // callback() stops one earlier
  registry.set_option("acceptable_iter", std::numeric_limits<int>::max());
  // Fatrop treats a reduced Hessian as indefinite if a diagonal entry of its Cholesky factor is
  // below this fraction of the largest. Near the solution the barrier's curvature is 1e12 times the
  // cost's, so the default 1e-6 rejects every step (HyQ step, 41 intervals, smallest eigenvalue
  // 4e-3: not solved in 301 iterations, with this value solved in 13).
  registry.set_option("linsol_pivot_tol", 1e-12);
  // First regularisation and its growth factor. The defaults 1e-4 and 100 overshoot (Talos weight
  // shift, 4 and 12 intervals: not solved in 292 and 123 iterations, with these values solved in 66
  // and 27).
  registry.set_option("delta_w0", 1.0);
  registry.set_option("kappa_wplusem", 8.0);
  // See IpoptSolver.
  registry.set_option("mu_init", options.is_warm_start ? 1e-5 : 1e-3);
  if (options.is_warm_start) {
    registry.set_option("bound_push", 1e-4);
    registry.set_option("bound_frac", 1e-4);
  }
}

}  // namespace

std::string FatropSolver::name() const { return "Fatrop"; }

std::string FatropSolver::version() const {
  const std::string kernels = linear_algebra();
  return fmt::format("{}, BLASFEO {}", PROWL_FATROP_VERSION,
                     kernels.empty() ? "with generic kernels" : "for " + kernels);
}

std::string FatropSolver::linear_algebra() {
  char text[256] = {};  // its longest string is far shorter
  blasfeo_processor_library_string(text);
  std::string features = text;
  while (!features.empty() && features.back() == ' ') features.pop_back();
  return features;
}

std::string FatropSolver::processor() {
  int features = 0;
  blasfeo_processor_cpu_features(&features);
  char text[256] = {};
  blasfeo_processor_feature_string(features, text);
  return text;
}

std::optional<std::string> FatropSolver::why_unsupported(Nlp& nlp) const {
  if (const auto reason = why_missing_instructions("libblasfeo.so", linear_algebra(), processor())) {
    return *reason + ": install the one of the pinned casadi wheel (scripts/setup), or use another --solver";
  }
  if (const auto reason = why_no_chain(nlp, "Fatrop")) return reason;
  if (nlp.stagewise()->closure().rows() > 0) return "Fatrop has no cycles: their ends need riccati or ipopt";
  return std::nullopt;
}

SolveResult FatropSolver::solve(Nlp& nlp, const VectorXd& z_guess, const SolverOptions& options) const {
  check_arguments(nlp, z_guess, options);
  const double began = wall_seconds();
  const double cpu_began = cpu_seconds();
  if (const auto reason = why_unsupported(nlp)) {
    SolveResult result;
    result.message = *reason;
    result.z = z_guess;
    return result;
  }
  StagewiseNlp& stages = *nlp.stagewise();
  const auto problem = std::make_shared<FatropProblem>(stages, stages.stages(z_guess), options, began);
  SolveResult result;
  result.z = z_guess;
  Stopped stopped{SolveStatus::solver_failed, ""};
  bool gave_up = true;  // without an exception: a failed evaluation may be the reason
  Iterate chosen;
  try {
    fatrop::Banner::set_suppress(true);
    fatrop::OptionRegistry registry;
    fatrop::IpAlgBuilder<Type> builder(problem);
    const auto algorithm = builder.with_options_registry(&registry).build();
    set_options(registry, options);
    // See IpoptSolver; not in Fatrop's option registry.
    if (const auto nlp_of_method =
            std::dynamic_pointer_cast<fatrop::IpNlpOrig<Type>>(builder.get_ipdata()->get_nlp())) {
      nlp_of_method->set_bound_relax_factor(0.01 * options.tolerance);
    }
    fatrop::IpEqMultInitializer<Type> initializer(builder.get_ipdata(), builder.get_pd_solver());
    initializer.set_lam_max(kLargestMultiplier);
    problem->set_multiplier_estimate([&] { initializer.initialize_eq_mult(); });
    stopped = outcome(algorithm->optimize());
    chosen = problem->note(builder.get_ipdata()->current_iterate());
    result.iterations = builder.get_ipdata()->iteration_number();
  } catch (const Stopped& reason) {
    stopped = reason;
    gave_up = false;
    result.iterations = problem->iterations();
  } catch (...) {
    stopped = {SolveStatus::solver_failed, thrown_error()};
    result.iterations = problem->iterations();
  }
  result.status = stopped.status;
  result.message = stopped.message;
  if (gave_up && stopped.status == SolveStatus::solver_failed && !problem->failure().empty()) {
    result.status = SolveStatus::evaluation_failed;
    result.message = fmt::format("{}; {}", stopped.message, problem->failure());
  }
  if (result.status != SolveStatus::converged && !problem->best().stages.empty()) chosen = problem->best();
  if (!chosen.stages.empty()) result.z = stages.flat(chosen.stages);
  result.dual_violation = chosen.dual_violation;

  remeasure_result(nlp, options.tolerance, name(), result);
  result.times = problem->times();
  result.times.cpu = cpu_seconds() - cpu_began;
  result.seconds = wall_seconds() - began;
  return result;
}

}  // namespace prowl

/// What load_solver() looks for; the caller owns the result.
extern "C" [[gnu::visibility("default")]] prowl::NlpSolver* prowl_make_solver(const char* /*name*/) {
  return new prowl::FatropSolver();
}

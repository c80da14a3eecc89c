#include "prowl/session/plan_task.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <utility>

#include "prowl/error.hpp"
#include "prowl/session/environment.hpp"
#include "prowl/session/warm_start.hpp"
#include "prowl/solvers/make_solver.hpp"

namespace prowl {

namespace {

Trajectory warm_start_motion(const WarmStart& from, const DiscreteProblem& asked) {
  if (!from.record) return {};
  try {
    return warm_start(*from.record, asked);
  } catch (const InputError& error) {
    if (from.option.empty()) throw;
    throw InputError(fmt::format("{}: {}", from.option, error.what()));
  }
}

/// Records iterations and forwards them to the callbacks.
class Watch {
 public:
  Watch(const PlanRequest& request, PlanOptions& options) : request_(request) {
    options.on_level = [this](int intervals) {
      ++level_;
      if (request_.on_mesh) request_.on_mesh(intervals);
    };
    options.solver.on_iteration = [this](const SolveProgress& progress) {
      iterations_.push_back({std::max(level_, 0), progress});
      if (request_.on_iteration) request_.on_iteration(progress);
    };
  }
  Watch(const Watch&) = delete;
  Watch& operator=(const Watch&) = delete;

  std::vector<MeshIteration> take() { return std::move(iterations_); }

 private:
  const PlanRequest& request_;
  int level_ = -1;
  std::vector<MeshIteration> iterations_;
};

/// Thrown when a front end cancels the gain design.
struct NoMoreGains {};

/// Designs gains and returns why there are none: the plan is valid without them.
std::string add_gains(const PlanRequest& request, PlanRecord& record) {
  const MotionProblem& problem = record.task.problem;
  const TrackingOptions& options = record.task.tracking;
  std::function<void(const ReducedSample&)> on_sample;
  int samples = 0, done = 0;
  if (request.on_gain) {
    const std::vector<ReferencePhase> grid = reference_grid(problem, record.plan.trajectory, options.step);
    for (const ReferencePhase& phase : grid) samples += static_cast<int>(phase.samples.size());
    on_sample = [&, phases = std::ssize(grid)](const ReducedSample& sample) {
      const bool stands_on = sample.phase >= phases;  // the extra phase after the end
      if (!stands_on) ++done;
      if (!request.on_gain(done, samples)) throw NoMoreGains();
    };
  }
  try {
    record.feedback = design_feedback(problem, record.plan.trajectory, options, on_sample);
    return "";
  } catch (const NumericalError& error) {
    return error.what();
  } catch (const NoMoreGains&) {
    return "";
  }
}

/// Where the mesh is open, an earlier plan brings its own, if goals and terms have nodes there.
Mesh mesh_to_begin_on(const Task& task, const PlanRecord* earlier) {
  if (task.has_intervals || !earlier || earlier->plan.mesh.phases.size() != task.mesh.phases.size()) return task.mesh;
  const auto has_node = [&](const PhaseFraction& moment) {
    return earlier->plan.mesh.phases[moment.phase].node_at(moment.fraction).has_value();
  };
  return std::ranges::all_of(node_moments(task.problem), has_node) ? earlier->plan.mesh : task.mesh;
}

}  // namespace

const std::string& solver_name(const PlanRequest& request) {
  return request.solver.empty() ? solver_names().front() : request.solver;
}

std::optional<MeshTolerance> refinement_goal(const PlanRequest& request, const Task& task) {
  if (request.refine || task.has_intervals) return request.refine;
  return mesh_tolerance(CertificateGrade::draft);
}

void check(const PlanRequest& request) {
  if (request.threads < 1 || request.threads > kMostThreads) {
    throw InputError(fmt::format("threads: {} is not allowed; need 1 to {}", request.threads, kMostThreads));
  }
  if (solver_name(request) == "fatrop" && request.threads > 1) {
    throw InputError("threads: Fatrop evaluates one stage at a time; need 1, or another solver");
  }
  make_solver(solver_name(request));
}

PlannedTask plan_task(Task task, const PlanRequest& request) {
  check(request);
  const std::optional<MeshTolerance> tolerance = refinement_goal(request, task);
  if (!task.has_intervals && !request.coarse_first) {
    throw InputError("one mesh: the task has no intervals; need --intervals, or intervals in its phases");
  }
  const RefineOptions refine{.tolerance = tolerance.value_or(MeshTolerance{}),
                             .mesh_is_open = !task.has_intervals,
                             .on_round = request.on_round};
  const DiscreteProblem asked(task.problem, mesh_to_begin_on(task, request.warm_start.record));
  const std::unique_ptr<NlpSolver> solver = make_solver(solver_name(request));
  std::unique_ptr<NlpSolver> elastic_solver;
  PlanOptions options{.solver = task.solver,
                      .warm_start = warm_start_motion(request.warm_start, asked),
                      .resume = request.warm_start.resume,
                      .elastic_solver =
                          [&elastic_solver] {
                            elastic_solver = make_solver_if_installed("ipopt");
                            return elastic_solver.get();
                          },
                      .hessian = request.hessian,
                      .corrected = tolerance && request.warm_start.record && !request.warm_start.resume,
                      .coarse_first = request.coarse_first,
                      .on_iterate = request.on_iterate};
  options.solver.threads = request.threads;
  options.solver.interrupt = request.interrupt;
  Watch watch(request, options);

  PlannedTask planned{.record = {.task = std::move(task),
                                 .plan = {},
                                 .versions = versions_with(solver_name(request)),
                                 .warm_start = request.warm_start.folder},
                      .why_no_gains = {}};
  Plan& plan = planned.record.plan;
  if (tolerance) {
    RefinedPlan refined = make_refined_plan(asked, *solver, options, refine);
    plan = std::move(refined.plan);
    planned.interrupted = refined.interrupted;
  } else {
    plan = make_plan(asked, *solver, options);
    planned.interrupted = plan.result.status == SolveStatus::interrupted;
  }
  if (const auto& sizes = planned.record.task.robust; sizes && is_good(plan)) {
    try {
      RobustPlan robust = make_robust_plan(asked, plan, planned.record.task.tracking, *sizes, *solver, options,
                                           tolerance ? std::optional(refine) : std::nullopt);
      plan = std::move(robust.plan);
      planned.record.robustness = std::move(robust.robustness);
      planned.robust_is_stopped = robust.is_stopped;
      planned.interrupted = planned.interrupted || (request.interrupt && request.interrupt->load());
    } catch (const NumericalError& error) {  // no gains, no tube
      planned.record.robustness = {.sizes = *sizes, .tightest = fmt::format("feedback: {}", error.what())};
    }
  }
  planned.record.iterations = watch.take();
  if (request.gains && is_good(plan)) planned.why_no_gains = add_gains(request, planned.record);
  return planned;
}

}  // namespace prowl

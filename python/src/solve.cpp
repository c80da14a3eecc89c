#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>

#include "bindings.hpp"
#include "environment.hpp"
#include "interrupted.hpp"
#include "plan_object.hpp"
#include "prowl/error.hpp"
#include "prowl/io/warm_start.hpp"
#include "prowl/solvers/ipopt_solver.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "signals.hpp"

namespace prowl::python {
namespace {

/// What is told of an iteration.
struct Progress {
  int intervals = 0;  ///< of the mesh
  SolveProgress solve;
};

/// Tells Python of iterations, which may stop the solver.
class Observer : public Stop {
 public:
  explicit Observer(nb::object callback) : callback_(std::move(callback)) {}

  void begin_level(int intervals) {
    progress_.intervals = intervals;
    ++level_;
  }
  void operator()(const SolveProgress& solve) {
    iterations_.push_back({std::max(level_, 0), solve});
    progress_.solve = solve;
    ask([this] {
      if (!callback_.is_none()) callback_(progress_);
    });
  }
  const std::vector<MeshIteration>& iterations() const { return iterations_; }

 private:
  nb::object callback_;
  Progress progress_;
  int level_ = -1;
  std::vector<MeshIteration> iterations_;
};

/// Gains for a plan that is good. "" or why there are none: the plan is as good without.
std::string add_feedback(PlanRecord& record, Observer& observer) {
  if (!is_good(record.plan)) return "";
  constexpr int kSamples = 20;  // between two looks for Ctrl-C: about 10 ms
  SignalCheck check(kSamples);
  try {
    record.feedback = design_feedback(record.task.problem, record.plan.trajectory, record.task.tracking,
                                      [&check](const ReducedSample&) { check(); });
  } catch (const NumericalError& error) {
    return error.what();
  } catch (nb::python_error& error) {
    observer.keep(std::move(error));
  }
  return "";
}

nb::object solve(const Task& task, const std::string& solver_name, int threads, bool coarse_first,
                 const PlanObject* start_from, bool gains, nb::object on_iteration) {
  constexpr int kMostThreads = 256;
  if (threads < 1 || threads > kMostThreads)
    throw InputError(fmt::format("threads: {} is not allowed; need 1 to {}", threads, kMostThreads));
  if (solver_name == "fatrop" && threads > 1) {
    throw InputError("threads: Fatrop evaluates one stage at a time; need 1, or another solver");
  }
  const std::unique_ptr<NlpSolver> solver = make_solver(solver_name);
  const IpoptSolver hint_solver;
  Observer observer(std::move(on_iteration));
  PlanOptions options{.solver = task.solver};
  options.solver.on_iteration = [&observer](const SolveProgress& progress) { observer(progress); };
  options.solver.interrupt = &observer.stop();
  options.solver.threads = threads;
  options.on_level = [&observer](int intervals) { observer.begin_level(intervals); };
  options.hint_solver = &hint_solver;
  options.coarse_first = coarse_first;

  std::shared_ptr<PlanObject> plan;
  std::string note;
  {
    const nb::gil_scoped_release others_may_run;
    const DiscreteProblem asked(task.problem, task.mesh);
    if (start_from) {
      options.start_from = warm_start(start_from->record, asked);
      options.resume =
          start_from->record.plan.result.status != SolveStatus::converged;  // an iterate is no solution to stay near
    }
    Plan found = make_plan(asked, *solver, options);
    PlanRecord record{.task = task,
                      .plan = std::move(found),
                      .versions = cli::versions(),
                      .feedback = {},
                      .iterations = observer.iterations(),
                      .warm_start = start_from && start_from->read_from ? start_from->read_from->string() : ""};
    if (gains && !observer.stop()) note = add_feedback(record, observer);
    plan = std::make_shared<PlanObject>(std::move(record));
  }
  const nb::object result = nb::cast(plan);
  if (auto& error = observer.error()) {
    if (error->matches(PyExc_KeyboardInterrupt)) raise_interrupted(result);
    throw std::move(*error);
  }
  if (!note.empty() && PyErr_WarnEx(PyExc_RuntimeWarning, ("no gains: " + note).c_str(), 2) != 0)
    throw nb::python_error();
  return result;
}

}  // namespace

void bind_solve(nb::module_& module) {
  nb::class_<Progress>(module, "Progress", "One iteration of a solver.")
      .def_ro("intervals", &Progress::intervals, "Of the mesh that is being solved: coarse ones come first.")
      .def_prop_ro(
          "iteration", [](const Progress& p) { return p.solve.iteration; }, "On this mesh, from 0.")
      .def_prop_ro("cost", [](const Progress& p) { return p.solve.cost; })
      .def_prop_ro(
          "constraint_violation", [](const Progress& p) { return p.solve.constraint_violation; }, "Largest, unscaled.")
      .def_prop_ro("dual_violation", [](const Progress& p) { return p.solve.dual_violation; })
      .def_prop_ro(
          "seconds", [](const Progress& p) { return p.solve.elapsed_seconds; }, "On this mesh [s].")
      .def("__repr__", [](const Progress& p) {
        return fmt::format("<prowl.Progress {} intervals, iteration {}: cost {:.6g}, violation {:.2e}>", p.intervals,
                           p.solve.iteration, p.solve.cost, p.solve.constraint_violation);
      });
  module.def("solver_names", &solver_names, "Names of the solvers; the first is the default.");
  module.def("solve", &solve, nb::arg("task"), nb::kw_only(), nb::arg("solver") = solver_names().front(),
             nb::arg("threads") = 1, nb::arg("coarse_first") = true, nb::arg("start_from").none() = nb::none(),
             nb::arg("gains") = true, nb::arg("on_iteration") = nb::none(),
             nb::sig("def solve(task: Task, *, solver: str = 'riccati', threads: int = 1, coarse_first: bool = True, "
                     "start_from: Plan | None = None, gains: bool = True, "
                     "on_iteration: collections.abc.Callable[[Progress], object] | None = None) -> Plan"),
             "prowl.solve without the display of progress.");
}

}  // namespace prowl::python

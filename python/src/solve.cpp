#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "interrupted.hpp"
#include "plan_object.hpp"
#include "prowl/error.hpp"
#include "prowl/session/plan_task.hpp"
#include "prowl/solvers/make_solver.hpp"
#include "signals.hpp"

namespace prowl::python {
namespace {

/// Data of one iteration.
struct Progress {
  int intervals = 0;  ///< of the mesh
  SolveProgress solve;
};

/// An iteration with the current motion.
struct Iterate : Progress {
  Motion motion;
};

/// Reports iterations to Python, which may stop the solver.
class Observer : public Stop {
 public:
  Observer(nb::object on_iteration, nb::object on_iterate)
      : on_iteration_(std::move(on_iteration)), on_iterate_(std::move(on_iterate)) {}

  void watch(PlanRequest& request) {
    request.interrupt = &stop();
    request.on_mesh = [this](int intervals) { progress_.intervals = intervals; };
    request.on_iteration = [this](const SolveProgress& solve) {
      progress_.solve = solve;
      ask([this] {
        if (!on_iteration_.is_none()) on_iteration_(progress_);
      });
    };
    if (!on_iterate_.is_none()) {
      request.on_iterate = [this](const Plan& iterate) {
        Iterate told{progress_, Motion(iterate.trajectory)};
        ask([&] { on_iterate_(std::move(told)); });
      };
    }
    constexpr int kSamples = 20;  // between checks for Ctrl-C: about 10 ms
    request.on_gain = [this, calls = 0](int, int) mutable {
      if (calls++ % kSamples == 0) ask([] {});
      return !stop();
    };
  }

 private:
  nb::object on_iteration_, on_iterate_;
  Progress progress_;
};

CertificateGrade grade_of(const std::string& name) {
  for (const CertificateGrade grade : {CertificateGrade::draft, CertificateGrade::certified}) {
    if (name == to_string(grade)) return grade;
  }
  throw InputError(fmt::format("refine: '{}' is not allowed; need 'draft' or 'certified'", name));
}

nb::object solve(const Task& task, const std::string& solver, int threads, bool coarse_first,
                 const std::optional<std::string>& refine, const PlanObject* start_from, bool gains,
                 nb::object on_iteration, nb::object on_iterate) {
  PlanRequest request{.solver = solver, .threads = threads, .coarse_first = coarse_first, .gains = gains};
  if (refine) request.refine = mesh_tolerance(grade_of(*refine));
  Observer observer(std::move(on_iteration), std::move(on_iterate));
  observer.watch(request);
  if (start_from) {
    const bool is_solution = start_from->record.plan.result.status == SolveStatus::converged;
    request.warm_start = {.record = &start_from->record,
                          .resume = !is_solution,  // not a solution to stay close to
                          .folder = start_from->read_from ? start_from->read_from->string() : ""};
  }
  std::shared_ptr<PlanObject> plan;
  std::string why_no_gains;
  {
    const nb::gil_scoped_release others_may_run;
    PlannedTask planned = plan_task(task, request);
    why_no_gains = std::move(planned.why_no_gains);
    plan = std::make_shared<PlanObject>(std::move(planned.record));
  }
  const nb::object result = nb::cast(plan);
  if (auto& error = observer.error()) {
    if (error->matches(PyExc_KeyboardInterrupt)) {
      raise_interrupted("stopped; the best motion so far is in .plan", result, nb::none());
    }
    throw std::move(*error);
  }
  if (!why_no_gains.empty() && PyErr_WarnEx(PyExc_RuntimeWarning, ("no gains: " + why_no_gains).c_str(), 2) != 0) {
    throw nb::python_error();
  }
  return result;
}

}  // namespace

void bind_solve(nb::module_& module) {
  nb::class_<Progress>(module, "Progress", "One iteration of a solver.")
      .def_ro("intervals", &Progress::intervals, "Intervals of the current mesh; coarse meshes come first.")
      .def_prop_ro(
          "iteration", [](const Progress& p) { return p.solve.iteration; }, "Iteration on this mesh, from 0.")
      .def_prop_ro("cost", [](const Progress& p) { return p.solve.cost; })
      .def_prop_ro(
          "constraint_violation", [](const Progress& p) { return p.solve.constraint_violation; },
          "Largest violation, unscaled.")
      .def_prop_ro("dual_violation", [](const Progress& p) { return p.solve.dual_violation; })
      .def_prop_ro(
          "seconds", [](const Progress& p) { return p.solve.elapsed_seconds; }, "Time on this mesh [s].")
      .def("__repr__", [](const Progress& p) {
        return fmt::format("<prowl.Progress {} intervals, iteration {}: cost {:.6g}, violation {:.2e}>", p.intervals,
                           p.solve.iteration, p.solve.cost, p.solve.constraint_violation);
      });
  nb::class_<Iterate, Progress>(module, "Iterate", "One iteration of a solver, with its current motion.")
      .def_ro("motion", &Iterate::motion, nb::rv_policy::reference_internal,
              "Motion at the nodes of the current mesh; it does not satisfy the dynamics yet.");
  module.def("solver_names", &solver_names, "Names of the solvers; the first is the default.");
  module.def("solve", &solve, nb::arg("task"), nb::kw_only(), nb::arg("solver") = solver_names().front(),
             nb::arg("threads") = 1, nb::arg("coarse_first") = true, nb::arg("refine").none() = nb::none(),
             nb::arg("start_from").none() = nb::none(), nb::arg("gains") = true, nb::arg("on_iteration") = nb::none(),
             nb::arg("on_iterate") = nb::none(),
             nb::sig("def solve(task: Task, *, solver: str = 'riccati', threads: int = 1, coarse_first: bool = True, "
                     "refine: str | None = None, start_from: Plan | None = None, gains: bool = True, "
                     "on_iteration: collections.abc.Callable[[Progress], object] | None = None, "
                     "on_iterate: collections.abc.Callable[[Iterate], object] | None = None) -> Plan"),
             "prowl.solve without the progress bar.");
}

}  // namespace prowl::python

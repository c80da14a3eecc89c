#include "prowl/simulation/sweep.hpp"

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <chrono>
#include <future>
#include <limits>

#include "bindings.hpp"
#include "interrupted.hpp"
#include "module_files.hpp"
#include "plan_object.hpp"
#include "prowl/error.hpp"
#include "prowl/plan_folder/sweep_files.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "signals.hpp"

namespace prowl::python {
namespace {

namespace nb = nanobind;

/// prowl.Sweep: simulations of one plan, each perturbed differently.
struct SweepObject {
  std::shared_ptr<const PlanObject> plan;
  SweepRecord record;

  SuccessRate rate() const {
    const auto succeeds = [](const SweepCase& one) { return one.result.success(); };
    const auto successes = std::ranges::count_if(record.cases, succeeds);
    return success_rate(static_cast<int>(successes), static_cast<int>(record.cases.size()));
  }
};

/// One simulation, with its seed.
struct SweepCaseView {
  std::uint64_t seed = 0;
  bool success = false;
  std::vector<std::string> failures;
  std::string pushed_phase;
  double mass = 1.0, friction = 0.0;
};

std::vector<SweepCaseView> cases(const SweepObject& sweep) {
  std::vector<SweepCaseView> views;
  for (const SweepCase& one : sweep.record.cases) {
    views.push_back({sweep.record.first_seed + views.size(), one.result.success(), one.result.failures,
                     pushed_phase(*sweep.plan->tracker, one.options),
                     mass_factor(sweep.plan->problem().robot, one.options.physics),
                     one.options.physics.friction_scale});
  }
  return views;
}

/// Runs `work(on_done, interrupt)` on its own thread without the GIL, while this thread reports
/// progress to Python and checks for Ctrl-C.
template <class Work>
auto watched(Stop& python, const nb::object& on_progress, const Work& work) {
  std::atomic<int> done = 0, total = 0;
  const nb::gil_scoped_release others_may_run;
  auto result = std::async(std::launch::async, [&] {
    return work(
        [&](int finished, int all) {
          total = all;
          done = finished;
        },
        &python.stop());
  });
  int told = -1;
  const auto tell = [&] {
    python.ask([&] {
      if (total == 0 || done == told) return;
      told = done;
      if (!on_progress.is_none()) on_progress(told, total.load());
    });
  };
  while (result.wait_for(std::chrono::milliseconds(50)) != std::future_status::ready) tell();
  tell();
  return result.get();
}

void check_range(const char* name, double value, double least, double most) {
  if (value >= least && value <= most) return;
  throw InputError(fmt::format("{}: {} is not allowed; need {:g} to {:g}", name, value, least, most));
}

void check_arguments(const PlanObject& plan, int n, const PerturbationRanges& ranges, int breakdown) {
  constexpr double kAny = std::numeric_limits<double>::max();
  check_range("n", n, 1, 1'000'000);
  check_range("breakdown", breakdown, 0, 100'000);
  check_range("mass_spread", ranges.mass, 0.0, 0.9);
  for (const auto& [name, size] :
       {std::pair("push_impulse", ranges.push), std::pair("push_impulse_on_two_feet", ranges.push_on_two_feet)}) {
    if (size && !(*size >= 0.0 && *size <= kAny))
      throw InputError(fmt::format("{}: {} is not allowed; need a number >= 0 [N s]", name, *size));
  }
  if (!plan.tracker) throw InputError("this plan contains no gains: solve(gains=True) designs them for a good plan");
}

SweepObject sweep_plan(std::shared_ptr<const PlanObject> plan, int n, std::uint64_t seed, double mass_spread,
                       std::optional<double> push_impulse, std::optional<double> push_impulse_on_two_feet,
                       const std::vector<std::string>& kinds, int breakdown, bool open_loop,
                       const nb::object& on_progress) {
  PerturbationRanges ranges;
  ranges.mass = mass_spread;
  ranges.push = push_impulse;
  ranges.push_on_two_feet = push_impulse_on_two_feet;
  check_arguments(*plan, n, ranges, breakdown);
  ranges = only(kinds, ranges);
  const Task& task = plan->record.task;
  const Tracker& tracker = *plan->tracker;
  SimulationOptions options;
  options.open_loop = open_loop;
  options.physics.collisions = collision_shapes(plan->problem().robot, package_search({}));
  options.physics.friction = task.simulated_friction;
  std::vector<SimulationOptions> all;
  for (int i = 0; i < n; ++i)
    all.push_back(perturbed(task.problem, tracker, options, ranges, seed + static_cast<std::uint64_t>(i)));

  SweepObject sweep{plan, {.first_seed = seed, .asked = n, .ranges = ranges, .only = kinds}};
  Stop python;
  sweep.record.cases =
      watched(python, on_progress, [&](const SweepProgress& on_done, const std::atomic<bool>* interrupt) {
        return run_cases(task.problem, tracker, task.success, all, on_done, interrupt);
      });
  if (breakdown > 0 && !python.stop()) {
    sweep.record.breakdowns =
        watched(python, on_progress, [&](const SweepProgress& on_done, const std::atomic<bool>* interrupt) {
          return find_breakdowns(task.problem, tracker, task.success, options, seed, breakdown, on_done, interrupt);
        });
  }
  if (auto& error = python.error()) {
    if (!error->matches(PyExc_KeyboardInterrupt)) throw std::move(*error);
    const bool is_any = !sweep.record.cases.empty();
    sweep.record.interrupted = std::ssize(sweep.record.cases) < n || breakdown > 0;
    raise_interrupted("stopped; the simulations so far are in .sweep", nb::none(),
                      is_any ? nb::cast(std::move(sweep)) : nb::none());
  }
  return sweep;
}

}  // namespace

void bind_sweep(nb::module_& module) {
  nb::class_<SweepCaseView>(module, "SweepCase", "One simulation of a sweep.")
      .def_ro("seed", &SweepCaseView::seed, "`prowl simulate DIR --case SEED` repeats it.")
      .def_ro("success", &SweepCaseView::success)
      .def_ro("failures", &SweepCaseView::failures, "Violated criteria, in words.")
      .def_ro("pushed_phase", &SweepCaseView::pushed_phase, "Name of the phase at the middle of the push.")
      .def_ro("mass", &SweepCaseView::mass, "Factor on the mass of the robot.")
      .def_ro("friction", &SweepCaseView::friction, "Factor on the planned coefficients.")
      .def("__repr__", [](const SweepCaseView& one) {
        return fmt::format("<prowl.SweepCase seed {}: {}>", one.seed, one.success ? "success" : one.failures.front());
      });
  nb::class_<SweepObject>(module, "Sweep",
                          "Simulations of one plan with different masses, friction, pushes and sensor noise.")
      .def_prop_ro(
          "plan", [](const SweepObject& s) { return std::const_pointer_cast<PlanObject>(s.plan); },
          nb::sig("def plan(self) -> Plan"))
      .def_prop_ro("cases", &cases, "Cases in the order of their seeds.")
      .def_prop_ro(
          "successes", [](const SweepObject& s) { return s.rate().successes; }, "Number of successes.")
      .def_prop_ro(
          "success_rate", [](const SweepObject& s) { return s.rate().rate(); }, "Share of successes, 0 to 1.")
      .def_prop_ro(
          "interval_95", [](const SweepObject& s) { return std::pair(s.rate().lower, s.rate().upper); },
          "Interval that contains the true rate with 95 % (Clopper and Pearson).")
      .def(
          "summary", [](const SweepObject& s) { return sweep_summary(s.plan->record, *s.plan->tracker, s.record); },
          "Text that `prowl sweep` prints.")
      .def(
          "to_json", [](const SweepObject& s) { return sweep_json(s.plan->record, *s.plan->tracker, s.record); },
          "Text of sweep.json (docs/simulation.md).")
      .def(
          "__len__", [](const SweepObject& s) { return s.record.cases.size(); }, "Number of simulations.")
      .def("__repr__", [](const SweepObject& s) {
        return fmt::format("<prowl.Sweep {}: {} of {} succeed>", s.plan->problem().name, s.rate().successes,
                           s.rate().cases);
      });
  const PerturbationRanges defaults;
  module.def("sweep", &sweep_plan, nb::arg("plan"), nb::arg("n") = 200, nb::kw_only(), nb::arg("seed") = 1,
             nb::arg("mass_spread") = defaults.mass, nb::arg("push_impulse") = nb::none(),
             nb::arg("push_impulse_on_two_feet") = nb::none(), nb::arg("only") = nb::tuple(), nb::arg("breakdown") = 0,
             nb::arg("open_loop") = false, nb::arg("on_progress") = nb::none(),
             nb::sig("def sweep(plan: Plan, n: int = 200, *, seed: int = 1, mass_spread: float = 0.1, push_impulse: "
                     "float | None = None, push_impulse_on_two_feet: float | None = None, only: "
                     "collections.abc.Sequence[str] = (), breakdown: int = 0, open_loop: bool = "
                     "False, on_progress: collections.abc.Callable[[int, int], object] | None = None) -> Sweep"),
             "prowl.sweep of a plan, without the progress bar.");
}

}  // namespace prowl::python

#include <fmt/format.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>

#include "bindings.hpp"
#include "prowl/session/diagnose_task.hpp"
#include "prowl/task_file/task_file.hpp"
#include "screen/diagnosis_text.hpp"
#include "signals.hpp"

namespace nb = nanobind;

namespace prowl::python {
namespace {

/// A diagnosis with its texts and JSON.
struct DiagnosisObject {
  Diagnosis found;
  std::string headline, summary, json;
};

DiagnosisObject run_diagnosis(const Task& task, double max_time, const nb::object& on_step) {
  Stop python;
  DiagnosisOptions options{.solver = {}, .max_seconds = max_time};
  options.solver.interrupt = &python.stop();
  options.solver.on_iteration = [&python](const SolveProgress&) { python.ask([] {}); };
  options.on_step = [&](const std::string& what) {
    python.ask([&] {
      if (!on_step.is_none()) on_step(what);
    });
  };
  DiagnosisObject result;
  {
    const nb::gil_scoped_release others_may_run;
    result.found = diagnose_task(task, options);
    result.headline = diagnosis_headline(result.found, task.problem);
    result.summary = diagnosis_text(result.found, task.problem);
    result.json = diagnosis_json(result.found, task.problem);
  }
  if (auto& error = python.error()) throw std::move(*error);
  return result;
}

}  // namespace

void bind_diagnosis(nb::module_& module) {
  nb::class_<DiagnosisObject>(module, "Diagnosis",
                              "Why a task has no plan, and changes that would help (docs/diagnose.md).")
      .def_prop_ro(
          "solvable",
          [](const DiagnosisObject& d) { return d.found.is_undecided() ? std::optional<bool>() : d.found.solvable; },
          "True if the unchanged task has a plan; None if time or iterations ran out before this was known.")
      .def_prop_ro(
          "headline", [](const DiagnosisObject& d) { return d.headline; }, "The result in one sentence.")
      .def_prop_ro(
          "reasons", [](const DiagnosisObject& d) { return d.found.reasons; }, "Proofs that there is no such motion.")
      .def_prop_ro(
          "hints", [](const DiagnosisObject& d) { return d.found.hints; },
          "Doubts about postures of the initial guess.")
      .def(
          "summary", [](const DiagnosisObject& d) { return d.summary; }, "Text that `prowl diagnose` prints.")
      .def(
          "to_json", [](const DiagnosisObject& d) { return d.json; }, "Result of `prowl diagnose --json`.")
      .def("__repr__", [](const DiagnosisObject& d) { return "<prowl.Diagnosis " + d.headline + ">"; });
  module.def(
      "diagnose", &run_diagnosis, nb::arg("task"), nb::kw_only(), nb::arg("max_time") = DiagnosisOptions().max_seconds,
      nb::arg("on_step") = nb::none(),
      nb::sig(fmt::format("def diagnose(task: Task, *, max_time: float = {:.1f}, "
                          "on_step: collections.abc.Callable[[str], object] | None = None) -> Diagnosis",
                          DiagnosisOptions().max_seconds)
                  .c_str()),
      "Finds out why a task has no plan: which limit, phase, time, foot or joint, by how much, and the smallest\n"
      "changes of one number that make it solvable. max_time: total time limit [s]. on_step: called with a line\n"
      "about each step; its exceptions, and Ctrl-C, end the diagnosis and are raised here.");
}

}  // namespace prowl::python

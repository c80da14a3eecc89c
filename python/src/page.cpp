#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "bindings.hpp"
#include "module_files.hpp"
#include "plan_object.hpp"
#include "prowl/report_page/report_file.hpp"

namespace prowl::python {
namespace {

namespace nb = nanobind;

using Text = std::optional<std::string>;

std::optional<SourceText> named(const std::string& name, const Text& text) {
  if (!text) return std::nullopt;
  return SourceText{name, *text};
}

/// The page and its warnings.
std::pair<std::string, std::vector<std::string>> report_page(const PlanObject& plan, const std::string& directory,
                                                             const std::string& template_html,
                                                             const Text& simulation_csv, const Text& simulation_json,
                                                             const std::vector<std::string>& package_dirs) {
  ReportInputs inputs{.plan = plan.record, .directory = directory, .template_html = template_html};
  inputs.simulation = named("simulate.csv", simulation_csv);
  inputs.simulation_json = named("simulate.json", simulation_json);
  if (plan.tracker) inputs.tracking = plan.tracker->plan();
  const PackageSearch search = package_search(package_dirs);
  const nb::gil_scoped_release others_may_run;
  Report report = make_report(inputs, search);
  return {std::move(report.html), std::move(report.warnings)};
}

}  // namespace

/// For report() and Plan.show() of the package.
void bind_page(nb::module_& module) {
  module.def("report_page", &report_page, nb::arg("plan"), nb::kw_only(), nb::arg("directory"),
             nb::arg("template_html"), nb::arg("simulation_csv").none() = nb::none(),
             nb::arg("simulation_json").none() = nb::none(), nb::arg("package_dirs") = std::vector<std::string>{},
             "The page that replays a plan, made from the template, and its warnings. directory: of the plan, \"\" "
             "without one.");
}

}  // namespace prowl::python

#include <fmt/format.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "module_files.hpp"
#include "prowl/simulation/mujoco_xml.hpp"
#include "prowl/task_file/task_file.hpp"
#include "robot_source.hpp"
#include "screen/phase_table.hpp"
#include "terms.hpp"

namespace prowl::python {
namespace {

/// A phase with names instead of indices.
struct PhaseView {
  std::string name;
  std::vector<std::string> contacts, surfaces;
  double shortest = 0.0, longest = 0.0;  ///< [s]
  int intervals = 0;
};

std::vector<PhaseView> phases(const Task& task) {
  std::vector<PhaseView> all;
  for (std::size_t p = 0; p < task.problem.phases.size(); ++p) {
    const Phase& phase = task.problem.phases[p];
    PhaseView& view = all.emplace_back(
        PhaseView{phase.name, {}, {}, phase.duration.min, phase.duration.max, task.mesh.phases[p].intervals()});
    for (const PhaseContact& contact : phase.contacts) {
      view.contacts.push_back(task.problem.robot.contacts()[contact.contact].name);
      view.surfaces.push_back(task.problem.surfaces[contact.surface].name);
    }
  }
  return all;
}

using Point = std::array<double, 3>;

Point as_point(const Eigen::Vector3d& values) { return {values.x(), values.y(), values.z()}; }

std::vector<Point> corners(const Surface& surface) {
  std::vector<Point> points;
  for (const Eigen::Vector2d& corner : surface.patch) points.push_back(as_point(surface.at(corner)));
  return points;
}

using TermMap = std::map<std::string, TermObject>;

Task read_task(const std::filesystem::path& path, const Folders& package_dirs, std::optional<int> intervals,
               std::optional<int> max_iterations, std::optional<double> max_time, std::optional<double> tolerance,
               bool robust, const TermMap& own, bool allow_libraries) {
  return read_task_file(path, package_search(package_dirs), {intervals, max_iterations, max_time, tolerance, robust},
                        own_terms(own, allow_libraries));
}

/// A robot file: path and text.
using RobotFile = std::pair<std::filesystem::path, std::string>;

Task parse_task_text(const std::string& text, const std::filesystem::path& path,
                     const std::optional<RobotFile>& robot_file, const Folders& package_dirs,
                     std::optional<int> intervals, std::optional<int> max_iterations, std::optional<double> max_time,
                     std::optional<double> tolerance, bool robust, const TermMap& own, bool allow_libraries) {
  const SourceText task_file{std::filesystem::absolute(path), text};
  const TaskOverrides overrides{intervals, max_iterations, max_time, tolerance, robust};
  const PackageSearch search = package_search(package_dirs);
  const OwnTerms terms = own_terms(own, allow_libraries);
  if (!robot_file) return read_task_text(task_file, search, overrides, terms);
  return parse_task(task_file, {robot_file->first, robot_file->second}, search, overrides, {}, terms);
}

}  // namespace

void bind_task(nb::module_& module) {
  nb::class_<PhaseView>(module, "Phase", "A period with one set of contacts, divided into mesh intervals.")
      .def_ro("name", &PhaseView::name)
      .def_ro("contacts", &PhaseView::contacts, "Names of the contacts in stance.")
      .def_ro("surfaces", &PhaseView::surfaces, "Per contact, the name of its surface.")
      .def_ro("shortest", &PhaseView::shortest, "Shortest duration [s]; equals `longest` if fixed.")
      .def_ro("longest", &PhaseView::longest, "Longest duration [s].")
      .def_ro("intervals", &PhaseView::intervals, "Mesh intervals.")
      .def("__repr__", [](const PhaseView& phase) {
        return fmt::format("<prowl.Phase {}: {} contacts, {} intervals>", phase.name, phase.contacts.size(),
                           phase.intervals);
      });
  nb::class_<Surface>(module, "Surface", "A plane in the world, or a convex polygon of it, that contacts may touch.")
      .def_ro("name", &Surface::name)
      .def_prop_ro(
          "point", [](const Surface& s) { return as_point(s.point); }, "Any point of the plane [m].")
      .def_prop_ro(
          "normal", [](const Surface& s) { return as_point(s.normal); }, "Unit vector out of the ground.")
      .def_ro("friction", &Surface::friction, "Coulomb coefficient.")
      .def_prop_ro("patch", &corners, "Corners of the polygon in the world [m]; empty for a whole plane.")
      .def("__repr__", [](const Surface& s) { return fmt::format("<prowl.Surface {}>", s.name); });
  nb::class_<Task>(
      module, "Task",
      "A requested motion: robot, surfaces, phases, goals and costs of a task file. Immutable; for another goal,\n"
      "change the text and parse it again.")
      .def_prop_ro("name", [](const Task& task) { return task.problem.name; })
      .def_prop_ro(
          "robot",
          [](nb::handle self) {
            const Task& task = nb::cast<const Task&>(self);
            return robot_of(self, task.problem.robot, task.robot_file);
          },
          nb::sig("def robot(self) -> Robot"))
      .def_prop_ro("phases", &phases)
      .def_prop_ro(
          "surfaces", [](const Task& task) { return task.problem.surfaces; }, "Surfaces for the phases.")
      .def_prop_ro(
          "path", [](const Task& task) { return task.task_file.path; }, "Path of the task file.")
      .def_prop_ro(
          "text", [](const Task& task) { return task.task_file.text; }, "Text of the task file.")
      .def_prop_ro(
          "robot_text", [](const Task& task) { return task.robot_file.text; }, "Text of the robot file.")
      .def_prop_ro(
          "reference_text",
          [](const Task& task) {
            return task.reference_file ? std::optional(task.reference_file->text) : std::nullopt;
          },
          "Text of the file of [reference]; None without one.")
      .def_prop_ro(
          "own_terms",
          [](const Task& task) {
            TermMap terms;
            for (const auto& [name, term] : task.own_terms.known) terms[name] = {term};
            return terms;
          },
          "Terms of the caller's own that it was read with, by name.")
      .def_prop_ro(
          "allow_libraries", [](const Task& task) { return task.own_terms.allows_libraries; },
          "Whether libraries of terms that it names may run.")
      .def_prop_ro(
          "start",
          [](nb::handle self) { return view(nb::cast<const Task&>(self).problem.start_configuration(), self); },
          "Configuration at the start, q (nq).")
      .def(
          "phase_table", [](const Task& task) { return phase_table({task.problem, task.mesh}); },
          "The phases as a table to print.")
      .def(
          "mujoco_xml",
          [](const Task& task) {
            return mujoco_xml(task.problem.robot, task.problem.surfaces, {.friction = task.simulated_friction});
          },
          "The model of simulate() as an MJCF file.")
      .def("__repr__", [](const Task& task) {
        return fmt::format("<prowl.Task {}: {}, {} phase{}>", task.problem.name, task.problem.robot.name(),
                           task.problem.phases.size(), task.problem.phases.size() == 1 ? "" : "s");
      });
  module.def("read_task", &read_task, nb::arg("path"), nb::kw_only(), nb::arg("package_dirs") = Folders{},
             nb::arg("intervals") = nb::none(), nb::arg("max_iterations") = nb::none(),
             nb::arg("max_time") = nb::none(), nb::arg("tolerance") = nb::none(), nb::arg("robust") = false,
             nb::arg("own_terms") = TermMap{}, nb::arg("allow_libraries") = false,
             "Reads a task file, docs/task-file.md.");
  module.def("parse_task", &parse_task_text, nb::arg("text"), nb::arg("path"), nb::kw_only(),
             nb::arg("robot_file").none() = nb::none(), nb::arg("package_dirs") = Folders{},
             nb::arg("intervals") = nb::none(), nb::arg("max_iterations") = nb::none(),
             nb::arg("max_time") = nb::none(), nb::arg("tolerance") = nb::none(), nb::arg("robust") = false,
             nb::arg("own_terms") = TermMap{}, nb::arg("allow_libraries") = false,
             "Reads the text of a task file; paths in it are relative to the folder of `path`, which need not exist.\n"
             "robot_file: path and text that replace the robot file of the task.");
}

}  // namespace prowl::python

#include <fmt/format.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "bindings.hpp"
#include "module_files.hpp"
#include "package_function.hpp"
#include "plan_object.hpp"
#include "prowl/error.hpp"
#include "prowl/files/csv_table.hpp"
#include "prowl/plan_folder/motion_points.hpp"
#include "prowl/plan_folder/mujoco_keyframes.hpp"
#include "prowl/plan_folder/mujoco_visuals.hpp"
#include "prowl/plan_folder/robot_look.hpp"
#include "prowl/plan_folder/trajectory_csv.hpp"
#include "prowl/simulation/mujoco_xml.hpp"
#include "prowl/simulation/simulation.hpp"
#include "prowl/tracking/make_tracking_plan.hpp"
#include "prowl/transcription/cost_terms.hpp"
#include "robot_source.hpp"
#include "screen/plan_summary.hpp"
#include "terms.hpp"

namespace prowl::python {
namespace {

std::shared_ptr<const Tracker> make_tracker(const PlanRecord& record,
                                            const std::optional<std::filesystem::path>& directory) {
  if (record.feedback) return std::make_shared<Tracker>(make_tracking_plan(record.task.problem, *record.feedback));
  if (!directory || !std::filesystem::exists(*directory / "tracker.bin")) return nullptr;
  auto tracker = std::make_shared<Tracker>(Tracker::read((*directory / "tracker.bin").string()));
  check_fit(record.task.problem, *tracker);
  return tracker;
}

using TermMap = std::map<std::string, TermObject>;

std::shared_ptr<PlanObject> read(const std::filesystem::path& directory, const std::vector<std::string>& package_dirs,
                                 const TermMap& own, bool allow_libraries) {
  return std::make_shared<PlanObject>(
      read_plan(directory, package_search(package_dirs), own_terms(own, allow_libraries)), directory);
}

void save_plan(const PlanObject& plan, const std::filesystem::path& directory, std::optional<double> step) {
  if (plan.read_from) {
    throw InputError(fmt::format("this plan was read from {}, which contains all files: copy that folder",
                                 plan.read_from->string()));
  }
  if (step && !(*step > 0.0)) throw InputError(fmt::format("step: {} is not allowed; need a number > 0 [s]", *step));
  const nb::gil_scoped_release others_may_run;
  check_plan_directory(directory);
  write_plan(directory, plan.record, step);
}

Motion sampled(const PlanObject& plan, double step) {
  if (!(step > 0.0)) throw InputError(fmt::format("step: {} is not allowed; need a number > 0 [s]", step));
  return Motion(sample_uniformly(plan.record.plan.trajectory, step));
}

Motion at_times(const PlanObject& plan, const std::vector<double>& times) {
  const Trajectory& trajectory = plan.record.plan.trajectory;
  Trajectory sampled;
  for (const double t : times) {
    if (!(t >= 0.0 && t <= trajectory.duration())) {
      throw InputError(fmt::format("times: {} is not allowed; need 0 <= t <= {} s", t, trajectory.duration()));
    }
    sampled.nodes.push_back(sample(trajectory, t));
  }
  return Motion(sampled);
}

std::string to_csv(const PlanObject& plan, std::optional<double> step) {
  const Trajectory& nodes = plan.record.plan.trajectory;
  return trajectory_to_csv(plan.problem(), step ? sample_uniformly(nodes, *step) : nodes);
}

Motion simulated_motion(const PlanObject& plan, double step) {
  if (!plan.read_from) throw InputError("this plan was not read from a folder with simulate.csv");
  const std::filesystem::path file = *plan.read_from / "simulate.csv";
  if (!std::filesystem::exists(file)) {
    throw InputError(fmt::format("{}: no such file; first prowl simulate {}", file.string(), plan.read_from->string()));
  }
  const CsvTable table = read_csv_table(read_text_file(file, kLongestTable));
  Trajectory motion{simulated_points(plan.problem().robot, table, step)};
  if (motion.nodes.empty()) throw InputError(table.file + ": no row of finite numbers");
  for (TrajectoryPoint& point : motion.nodes) point.phase = sample(plan.record.plan.trajectory, point.time).phase;
  return Motion(motion);
}

/// The file and its warnings.
std::pair<std::string, std::vector<std::string>> mujoco_file(const PlanObject& plan, const Motion& motion,
                                                             const std::vector<std::string>& package_dirs) {
  const MotionProblem& problem = plan.problem();
  const Trajectory points = motion.trajectory();
  const PackageSearch search = package_search(package_dirs);
  const nb::gil_scoped_release others_may_run;
  std::vector<std::string> warnings;
  const RobotLook look = robot_look(problem.robot, search, warnings);
  const std::string model =
      mujoco_xml(problem.robot, problem.surfaces, {.friction = plan.record.task.simulated_friction});
  return {add_mujoco_keyframes(add_mujoco_visuals(model, problem.robot, look), problem, points), std::move(warnings)};
}

nb::dict term_costs(const PlanObject& plan) {
  nb::dict costs;
  for (const CostTerm& term : cost_terms(plan.problem(), plan.record.plan.trajectory)) {
    costs[term.key.c_str()] = term.cost;
  }
  return costs;
}

nb::dict term_rates(const PlanObject& plan) {
  nb::dict rates;
  for (const CostTerm& term : cost_terms(plan.problem(), plan.record.plan.trajectory)) {
    if (!term.key.starts_with(kTerminalCost)) rates[term.key.c_str()] = new_array(term.rate);
  }
  return rates;
}

/// Functions of the package as methods of a plan.
nb::object show(nb::handle plan, nb::handle simulation, int height) {
  return call_package("prowl._show.page", "show", plan, simulation, height);
}
nb::object plot(nb::handle plan, nb::handle simulation) {
  return call_package("prowl._show.plot", "plot", plan, simulation);
}
nb::object html(nb::handle plan) { return call_package("prowl._show.notebook", "plan_html", plan); }

}  // namespace

PlanObject::PlanObject(PlanRecord plan_record, std::optional<std::filesystem::path> directory)
    : record(std::move(plan_record)),
      motion(record.plan.trajectory),
      tracker(make_tracker(record, directory)),
      read_from(std::move(directory)) {}

void bind_plan(nb::module_& module) {
  const auto plan = [](nb::handle self) -> const PlanObject& { return nb::cast<const PlanObject&>(self); };
  nb::class_<PlanObject>(
      module, "Plan",
      "A motion with its solver result and certificate: `good` is True if the solver converged and the certificate\n"
      "passed. Arrays are read-only contiguous views at the N nodes of the mesh (two nodes at a phase transition).")
      .def_prop_ro(
          "t", [=](nb::handle self) { return view(plan(self).motion.t, self); }, "Times (N) [s].")
      .def_prop_ro(
          "phase", [=](nb::handle self) { return view(plan(self).motion.phase, self); },
          "Index of the phase (N), from 0.")
      .def_prop_ro(
          "q", [=](nb::handle self) { return view(plan(self).motion.q, self); },
          "Configurations (N, nq): base position [m], quaternion x y z w, joints [rad or m].")
      .def_prop_ro(
          "v", [=](nb::handle self) { return view(plan(self).motion.v, self); },
          "Velocities (N, nv): base twist in the base frame [m/s, rad/s], joint rates.")
      .def_prop_ro(
          "a", [=](nb::handle self) { return view(plan(self).motion.a, self); },
          "Accelerations (N, nv): rates of the components of v [m/s^2, rad/s^2].")
      .def_prop_ro(
          "tau", [=](nb::handle self) { return view(plan(self).motion.tau, self); }, "Torques (N, nu) [N m or N].")
      .def_prop_ro(
          "f", [=](nb::handle self) { return contacts_view(plan(self).motion.f, self); },
          "Contact forces on the robot (N, contacts, 3), world axes [N]; zero where a contact is in the air.")
      .def_prop_ro(
          "duration", [](const PlanObject& p) { return p.record.plan.trajectory.duration(); }, "[s]")
      .def_prop_ro(
          "good", [](const PlanObject& p) { return is_good(p.record.plan); },
          "True if the solver converged and the certificate passed.")
      .def_prop_ro(
          "status", [](const PlanObject& p) { return to_string(p.record.plan.result.status); },
          "Why the solver stopped: \"converged\", \"infeasible\", \"iteration_limit\", \"time_limit\", "
          "\"interrupted\",\n"
          "\"evaluation_failed\" or \"solver_failed\".")
      .def_prop_ro(
          "message", [](const PlanObject& p) { return p.record.plan.result.message; }, "Message of the solver.")
      .def_prop_ro(
          "reasons", [](const PlanObject& p) { return p.record.plan.reasons; },
          "Proofs, before the solve, that there is no such motion; may be empty.")
      .def_prop_ro(
          "hints", [](const PlanObject& p) { return p.record.plan.hints; },
          "Possible causes, after a solve that did not converge.")
      .def_prop_ro("cost", [](const PlanObject& p) { return p.record.plan.result.cost; })
      .def_prop_ro("cost_terms", &term_costs, nb::sig("def cost_terms(self) -> dict[str, float]"),
                   "Terms of the cost by keys of the task file (\"torque\", "
                   "\"terminal_cost.base_position\"); their sum is `cost`.")
      .def_prop_ro("cost_rates", &term_rates,
                   nb::sig("def cost_rates(self) -> dict[str, numpy.typing.NDArray[numpy.float64]]"),
                   "Terms of the running cost at each node (N) [1/s], by keys of the task file.")
      .def_prop_ro(
          "iterations", [](const PlanObject& p) { return p.record.plan.result.iterations; },
          "Iterations on all meshes.")
      .def_prop_ro(
          "seconds", [](const PlanObject& p) { return p.record.plan.result.seconds; }, "Time of the solver [s].")
      .def_prop_ro(
          "solver", [](const PlanObject& p) { return p.record.plan.solver; }, "Name of the solver.")
      .def_prop_ro(
          "versions", [](const PlanObject& p) { return p.record.versions; }, "Versions of Prowl and its libraries.")
      .def_prop_ro(
          "certificate", [](const PlanObject& p) -> const Certificate& { return p.record.plan.certificate; },
          nb::rv_policy::reference_internal)
      .def_prop_ro(
          "task", [](const PlanObject& p) -> const Task& { return p.record.task; }, nb::rv_policy::reference_internal)
      .def_prop_ro(
          "robot",
          [=](nb::handle self) {
            return robot_of(self, plan(self).problem().robot, plan(self).record.task.robot_file);
          },
          nb::sig("def robot(self) -> Robot"))
      .def_prop_ro(
          "path", [](const PlanObject& p) { return p.read_from; },
          "Folder that the plan was read from; None for a solved plan.")
      .def_prop_ro(
          "tracker", [](const PlanObject& p) { return p.tracker; }, nb::sig("def tracker(self) -> Tracker | None"),
          "Reference, feedback gains and control law; None without gains.")
      .def_ro("motion", &PlanObject::motion, "The arrays above as one Motion.")
      .def("sample", &sampled, nb::arg("step"),
           "The motion every `step` seconds and at its end, interpolated as in the transcription.")
      .def("at", &at_times, nb::arg("times"),
           "The motion at these times [s]; at a phase transition that of the later phase.")
      .def("simulated_motion", &simulated_motion, nb::arg("step") = 0.0,
           "For a plan read from a folder: true motion of simulate.csv, without a, at rows at least `step` [s] apart.\n"
           "f is the measured force. The last phase continues after the end of the plan.")
      .def("to_csv", &to_csv, nb::arg("step") = nb::none(),
           "Text of trajectory.csv, at the nodes or every `step` seconds.")
      .def("mujoco_xml", &mujoco_file, nb::arg("motion"), nb::kw_only(),
           nb::arg("package_dirs") = std::vector<std::string>{},
           "An MJCF file with the model that simulate() runs, the meshes of the robot, and one keyframe an instant.\n"
           "Also lines about meshes that cannot be read.")
      .def(
          "mujoco_keyframes",
          [](const PlanObject& p, const Motion& motion, const std::string& model_file) {
            return mujoco_keyframes_xml(p.problem(), motion.trajectory(), model_file);
          },
          nb::arg("motion"), nb::arg("model_file"),
          "An MJCF file that includes `model_file` (Task.mujoco_xml) and contains one keyframe per instant of a "
          "motion.")
      .def(
          "summary", [](const PlanObject& p) { return plan_report(p.record); }, "Text that `prowl plan` prints.")
      .def(
          "to_json", [](const PlanObject& p) { return plan_report_json(p.record, p.read_from.value_or("")); },
          "plan.json (docs/plan-directory.md) without the texts of task, robot and URDF.")
      .def("show", &show, nb::arg("simulation").none() = nb::none(), nb::kw_only(), nb::arg("height") = 720,
           nb::sig("def show(self, simulation: Simulation | None = None, *, height: int = 720) -> None"),
           "Shows the page of `prowl report`: below the cell of a notebook, `height` pixels high, or in the browser.")
      .def("plot", &plot, nb::arg("simulation").none() = nb::none(),
           nb::sig("def plot(self, simulation: Simulation | None = None) -> matplotlib.figure.Figure"),
           "Draws base position, contact forces, joint torques and the largest share of the torque limits over time "
           "with\n"
           "Matplotlib. Returns the figure: notebooks show it, figure.savefig(path) saves it.")
      .def("_repr_html_", &html, nb::sig("def _repr_html_(self) -> str"))
      .def("write", &save_plan, nb::arg("directory"), nb::arg("step") = nb::none(),
           "Writes the same folder as `prowl plan` (docs/plan-directory.md), atomically; with `step` [s] also\n"
           "trajectory_uniform.csv.")
      .def(
          "__len__", [](const PlanObject& p) { return p.motion.t.size(); }, "Number of nodes, N.")
      .def("__repr__", [](const PlanObject& p) {
        const Plan& found = p.record.plan;
        return fmt::format("<prowl.Plan {}: {}, certificate {}, {} nodes, {:.3g} s>", p.problem().name,
                           to_string(found.result.status), to_string(found.certificate.grade), p.motion.t.size(),
                           found.trajectory.duration());
      });
  module.def("read_plan", &read, nb::arg("directory"), nb::arg("package_dirs") = std::vector<std::string>{},
             nb::arg("own_terms") = TermMap{}, nb::arg("allow_libraries") = false,
             "Reads a folder written by `prowl plan` or Plan.write; own_terms and allow_libraries as for read_task().");
}

}  // namespace prowl::python

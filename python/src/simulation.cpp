#include <fmt/format.h>
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
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
#include "prowl/plan_folder/simulation_files.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "pushes.hpp"
#include "signals.hpp"

namespace prowl::python {
namespace {

/// prowl.Simulation: results as arrays, one row per sample.
struct SimulationObject {
  SimulationObject(std::shared_ptr<const PlanObject> simulated, SimulationRecord made);

  std::shared_ptr<const PlanObject> plan;
  SimulationRecord record;
  Eigen::VectorXd t;
  RowMatrix q, v, q_ref, v_ref, q_tracked, q_seen, v_seen, feedforward, feedback, tau, f;
};

SimulationObject::SimulationObject(std::shared_ptr<const PlanObject> simulated, SimulationRecord made)
    : plan(std::move(simulated)), record(std::move(made)) {
  const std::vector<SimulationSample>& samples = record.result.samples;
  q = rows_of(samples, &SimulationSample::q);
  v = rows_of(samples, &SimulationSample::v);
  q_ref = rows_of(samples, &SimulationSample::q_ref);
  v_ref = rows_of(samples, &SimulationSample::v_ref);
  q_tracked = rows_of(samples, &SimulationSample::q_tracked);
  q_seen = rows_of(samples, &SimulationSample::q_seen);
  v_seen = rows_of(samples, &SimulationSample::v_seen);
  feedforward = rows_of(samples, &SimulationSample::feedforward);
  feedback = rows_of(samples, &SimulationSample::feedback);
  tau = rows_of(samples, &SimulationSample::tau);
  t.resize(q.rows());
  f.setZero(q.rows(), 3 * static_cast<Eigen::Index>(plan->problem().robot.contacts().size()));
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    const SimulationSample& sample = samples[k];
    t(k) = sample.time;
    for (std::size_t c = 0; c < sample.contacts.size(); ++c) {
      f.row(k).segment<3>(3 * static_cast<Eigen::Index>(c)) = sample.contacts[c].force.transpose();
    }
  }
}

std::shared_ptr<SimulationObject> simulate_plan(std::shared_ptr<const PlanObject> plan, bool open_loop,
                                                bool perfect_state, double noise, double delay, double bandwidth,
                                                double control_rate, double mass, std::optional<double> friction,
                                                const std::vector<PushArgument>& pushes, double push_duration,
                                                double step, std::uint64_t seed, double record_rate) {
  if (!plan->tracker) throw InputError("this plan contains no gains: solve(gains=True) designs them for a good plan");
  SimulationOptions options;
  options.open_loop = open_loop;
  options.perfect_state = perfect_state;
  options.noise_scale = noise;
  options.delay = delay;
  options.bandwidth = bandwidth;
  options.control_rate = control_rate;
  options.physics.step = step;
  options.physics.mass_scale = mass;
  options.physics.friction = friction ? friction : plan->record.task.simulated_friction;
  options.physics.collisions = collision_shapes(plan->problem().robot, package_search({}));
  if (!(push_duration > 0.0))
    throw InputError(fmt::format("push_duration: {} is not allowed; need > 0 s", push_duration));
  if (!(record_rate > 0.0)) throw InputError(fmt::format("record_rate: {} is not allowed; need > 0 Hz", record_rate));
  options.pushes = pushes_of(pushes, push_duration);
  options.seed = seed;
  options.record_rate = record_rate;
  constexpr int kTicks = 50;

  const nb::gil_scoped_release others_may_run;
  SimulationResult result = simulate(plan->problem(), *plan->tracker, plan->record.task.success, options,
                                     [check = SignalCheck(kTicks)](double, double) mutable { check(); });
  return std::make_shared<SimulationObject>(std::move(plan), SimulationRecord{std::move(options), std::move(result)});
}

void save_simulation(const SimulationObject& simulation, const std::filesystem::path& directory) {
  const nb::gil_scoped_release others_may_run;
  write_simulation(directory, simulation.plan->record, simulation.record);
}

template <RowMatrix SimulationObject::* rows>
Matrix rows_view(nb::handle self) {
  return view(nb::cast<const SimulationObject&>(self).*rows, self);
}

}  // namespace

void bind_simulation(nb::module_& module) {
  const auto result = [](const SimulationObject& s) -> const SimulationResult& { return s.record.result; };
  nb::class_<ErrorMeasure>(module, "ErrorMeasure", "Size of an error over a simulation.")
      .def_ro("largest", &ErrorMeasure::largest)
      .def_ro("rms", &ErrorMeasure::rms)
      .def_ro("rest", &ErrorMeasure::rest, "Largest error in the last 0.2 s.")
      .def("__repr__", [](const ErrorMeasure& e) {
        return fmt::format("<prowl.ErrorMeasure largest {:.3g}, rms {:.3g}, at rest {:.3g}>", e.largest, e.rms, e.rest);
      });
  nb::class_<SimulationObject>(
      module, "Simulation",
      "Simulation of a plan with its gains in MuJoCo (docs/simulation.md), at S samples. Arrays are read-only.")
      .def_prop_ro(
          "success", [=](const SimulationObject& s) { return result(s).success(); },
          "True if the judge finds no failure.")
      .def_prop_ro(
          "failures", [=](const SimulationObject& s) { return result(s).failures; }, "Violated criteria, in words.")
      .def_prop_ro(
          "end", [](const SimulationObject& s) { return to_string(s.record.result.end); },
          "\"finished\", \"fell\" or \"diverged\".")
      .def_prop_ro(
          "end_time", [=](const SimulationObject& s) { return result(s).end_time; }, "[s]")
      .def_prop_ro(
          "base_position_error", [=](const SimulationObject& s) { return result(s).base_position; },
          "Distance from the planned base [m].")
      .def_prop_ro(
          "base_angle_error", [=](const SimulationObject& s) { return result(s).base_angle; }, "[rad]")
      .def_prop_ro(
          "joint_error", [=](const SimulationObject& s) { return result(s).joints; },
          "Largest: of the worst joint; rms: of all [rad].")
      .def_prop_ro(
          "slip", [=](const SimulationObject& s) { return result(s).slip; },
          "Per contact: largest distance from where its stance began [m].")
      .def_prop_ro(
          "largest_torque_share", [=](const SimulationObject& s) { return result(s).largest_torque_share; },
          "Largest torque, as a share of its limit.")
      .def_prop_ro(
          "plan", [](const SimulationObject& s) { return std::const_pointer_cast<PlanObject>(s.plan); },
          nb::sig("def plan(self) -> Plan"))
      .def_prop_ro(
          "t", [](nb::handle self) { return view(nb::cast<const SimulationObject&>(self).t, self); }, "Times (S) [s].")
      .def_prop_ro("q", &rows_view<&SimulationObject::q>, "True configurations (S, nq).")
      .def_prop_ro("v", &rows_view<&SimulationObject::v>, "True velocities (S, nv).")
      .def_prop_ro("q_ref", &rows_view<&SimulationObject::q_ref>, "Planned configurations (S, nq).")
      .def_prop_ro("v_ref", &rows_view<&SimulationObject::v_ref>, "Planned velocities (S, nv).")
      .def_prop_ro("q_tracked", &rows_view<&SimulationObject::q_tracked>,
                   "Planned configurations with the feet on the ground that they found (S, nq).")
      .def_prop_ro("q_seen", &rows_view<&SimulationObject::q_seen>,
                   "Estimated configurations, given to the controller (S, nq).")
      .def_prop_ro("v_seen", &rows_view<&SimulationObject::v_seen>,
                   "Estimated velocities, given to the controller (S, nv).")
      .def_prop_ro("feedforward", &rows_view<&SimulationObject::feedforward>,
                   "Commanded feedforward torques (S, nu) [N m].")
      .def_prop_ro("feedback", &rows_view<&SimulationObject::feedback>, "Commanded feedback torques (S, nu) [N m].")
      .def_prop_ro("tau", &rows_view<&SimulationObject::tau>, "Torques at the joints (S, nu) [N m].")
      .def_prop_ro(
          "f", [](nb::handle self) { return contacts_view(nb::cast<const SimulationObject&>(self).f, self); },
          "Contact forces on the robot (S, contacts, 3), world axes [N].")
      .def(
          "summary", [](const SimulationObject& s) { return simulation_summary(s.plan->record, s.record); },
          "Text that `prowl simulate` prints.")
      .def(
          "to_json", [](const SimulationObject& s) { return simulation_json(s.plan->record, s.record); },
          "Text of simulate.json (docs/simulation.md).")
      .def(
          "to_csv",
          [](const SimulationObject& s) { return simulation_csv(s.plan->problem().robot, s.record.result.samples); },
          "Text of simulate.csv (docs/simulation.md).")
      .def(
          "_repr_html_", [](nb::handle self) { return call_package("prowl._show.notebook", "simulation_html", self); },
          nb::sig("def _repr_html_(self) -> str"))
      .def("write", &save_simulation, nb::arg("directory"),
           "Writes simulate.json and simulate.csv into the folder of the plan.")
      .def(
          "__len__", [](const SimulationObject& s) { return s.t.size(); }, "Number of samples, S.")
      .def("__repr__", [](const SimulationObject& s) {
        return fmt::format("<prowl.Simulation {}: {}, {} at {:.3g} s>", s.plan->problem().name,
                           s.record.result.success() ? "success" : "no success", to_string(s.record.result.end),
                           s.record.result.end_time);
      });
  const SimulationOptions defaults;
  module.def(
      "simulate", &simulate_plan, nb::arg("plan"), nb::kw_only(), nb::arg("open_loop") = false,
      nb::arg("perfect_state") = false, nb::arg("noise") = defaults.noise_scale, nb::arg("delay") = defaults.delay,
      nb::arg("bandwidth") = defaults.bandwidth, nb::arg("control_rate") = defaults.control_rate,
      nb::arg("mass") = defaults.physics.mass_scale, nb::arg("friction") = nb::none(),
      nb::arg("pushes") = std::vector<PushArgument>{}, nb::arg("push_duration") = Push{}.duration,
      nb::arg("step") = defaults.physics.step, nb::arg("seed") = defaults.seed, nb::arg("record_rate") = kRecordRate,
      "Runs a plan with its gains in MuJoCo, with sensors, estimator and delay, like `prowl simulate`. "
      "Deterministic.\n\n"
      "open_loop: feedforward torques only. perfect_state: give the controller the true state. noise: factor on "
      "sensor\n"
      "noise. delay: from sensors to torque [s]. bandwidth: of the actuators [Hz]; 0: ideal. control_rate [Hz]. mass:\n"
      "factor on all masses and inertias. friction: of all surfaces, replaces that of the task. pushes: (time [s],\n"
      "impulse [N s] in world x, y, z) on the base, each push_duration [s] long. step: of the physics [s].\n"
      "record_rate: of the recorded samples [Hz].");
}

}  // namespace prowl::python

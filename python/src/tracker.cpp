#include "prowl/tracker/tracker.hpp"

#include <fmt/format.h>
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include "arrays.hpp"
#include "bindings.hpp"
#include "prowl/error.hpp"

namespace prowl::python {
namespace {

using State = Eigen::Ref<const Eigen::VectorXd>;

void check_state(const Tracker& tracker, const State& q, const State& v) {
  const TrackingPlan& plan = tracker.plan();
  if (q.size() == plan.nq() && v.size() == plan.nv()) return;
  throw InputError(fmt::format("q, v: {} and {} numbers; need {} and {}", q.size(), v.size(), plan.nq(), plan.nv()));
}

Array torque(const Tracker& tracker, double t, const State& q, const State& v) {
  check_state(tracker, q, v);
  Eigen::VectorXd tau(tracker.plan().nu());
  tracker.torque(t, q, v, tau);
  return new_array(tau);
}

Array feedforward(const Tracker& tracker, double t) {
  Eigen::VectorXd tau(tracker.plan().nu());
  tracker.feedforward(t, tau);
  return new_array(tau);
}

Array feedback(const Tracker& tracker, double t, const State& q, const State& v) {
  check_state(tracker, q, v);
  Eigen::VectorXd tau(tracker.plan().nu());
  tracker.feedback(t, q, v, tau);
  return new_array(tau);
}

std::pair<Array, Array> reference(const Tracker& tracker, double t) {
  Eigen::VectorXd q(tracker.plan().nq()), v(tracker.plan().nv());
  tracker.reference(t, q, v);
  return {new_array(q), new_array(v)};
}

Array gains(const Tracker& tracker, double t) {
  const auto nu = tracker.plan().nu(), nx = 2 * tracker.plan().nv();
  Eigen::MatrixXd K(nu, nx);
  tracker.gains(t, K);
  const RowMatrix rows = K;
  return new_array({rows.data(), rows.data() + rows.size()},
                   {static_cast<std::size_t>(nu), static_cast<std::size_t>(nx)});
}

/// Times of all samples: equal steps within each segment.
Array times(const Tracker& tracker) {
  std::vector<double> all;
  for (const TrackingPlan::Segment& segment : tracker.plan().segments) {
    const Eigen::VectorXd some = Eigen::VectorXd::LinSpaced(segment.samples, segment.start, segment.end);
    all.insert(all.end(), some.begin(), some.end());
  }
  const std::size_t count = all.size();
  return new_array(std::move(all), {count});
}

/// samples x nu x 2 nv; each K is column-major in memory.
Block all_gains(const TrackingPlan& plan, nb::handle owner) {
  const auto nu = static_cast<std::size_t>(plan.nu()), nx = 2 * static_cast<std::size_t>(plan.nv());
  const auto stride = static_cast<std::int64_t>(nu);
  return {plan.gains.data(),
          {static_cast<std::size_t>(plan.num_samples()), nu, nx},
          owner,
          {stride * static_cast<std::int64_t>(nx), 1, stride}};
}

/// Names of the contacts in stance at time t.
std::vector<std::string> contacts(const Tracker& tracker, double t) {
  std::vector<std::string> names;
  const TrackingPlan& plan = tracker.plan();
  for (std::size_t c = 0; c < plan.contact_names.size(); ++c) {
    if (tracker.segment(t).in_contact[c]) names.push_back(plan.contact_names[c]);
  }
  return names;
}

}  // namespace

void bind_tracker(nb::module_& module) {
  const auto plan = [](nb::handle self) -> const TrackingPlan& { return nb::cast<const Tracker&>(self).plan(); };
  nb::class_<Tracker>(
      module, "Tracker",
      "Control law that keeps a robot on its plan (docs/tracking.md):\n\n"
      "    tau = tau*(t) + K(t) (x* - x),  within the torque limits\n\n"
      "x* - x (2 nv): displacement of the base to the reference in the world [m], rotation vector in the base frame\n"
      "[rad], joints, then the difference of v. S samples, by default 2 ms apart. Robots use the same in C++:\n"
      "prowl/tracker and tracker.bin.")
      .def_static(
          "read", [](const std::filesystem::path& path) { return Tracker::read(path.string()); }, nb::arg("path"),
          "Reads tracker.bin.")
      .def_prop_ro("t", &times, nb::rv_policy::reference,
                   "Times of the samples (S) [s]; two samples at a phase transition.")
      .def_prop_ro(
          "q", [=](nb::handle self) { return transposed_view(plan(self).q, self); },
          "Reference configurations (S, nq), a read-only view.")
      .def_prop_ro(
          "v", [=](nb::handle self) { return transposed_view(plan(self).v, self); },
          "Reference velocities (S, nv), a read-only view.")
      .def_prop_ro(
          "tau", [=](nb::handle self) { return transposed_view(plan(self).tau, self); },
          "Feedforward torques (S, nu) [N m], a read-only view.")
      .def_prop_ro(
          "K", [=](nb::handle self) { return all_gains(plan(self), self); },
          "Gains (S, nu, 2 nv) [N m per m, rad, m/s, rad/s], a read-only view; each K is column-major.")
      .def_prop_ro("start", &Tracker::start, "[s]")
      .def_prop_ro("end", &Tracker::end, "[s]; after it, the last sample holds.")
      .def_prop_ro("joint_names", [](const Tracker& tracker) { return tracker.plan().joint_names; })
      .def_prop_ro("contact_names", [](const Tracker& tracker) { return tracker.plan().contact_names; })
      .def("torque", &torque, nb::arg("t"), nb::arg("q"), nb::arg("v"),
           "tau (nu) [N m] for the measured state q (nq), v (nv) at time t [s], within the limits of the joints.")
      .def("feedforward", &feedforward, nb::arg("t"), "tau*(t) (nu) [N m], not limited.")
      .def("feedback", &feedback, nb::arg("t"), nb::arg("q"), nb::arg("v"), "K(t) (x* - x) (nu) [N m], not limited.")
      .def("reference", &reference, nb::arg("t"), "(q, v) of the plan at time t [s].")
      .def("gains", &gains, nb::arg("t"), "K(t) (nu, 2 nv).")
      .def(
          "phase", [](const Tracker& tracker, double t) { return tracker.segment(t).name; }, nb::arg("t"),
          "Name of the phase at time t [s].")
      .def("contacts", &contacts, nb::arg("t"), "Names of the contacts in stance at time t [s].")
      .def(
          "__len__", [](const Tracker& tracker) { return tracker.plan().num_samples(); }, "Number of samples, S.")
      .def("__repr__", [](const Tracker& tracker) {
        return fmt::format("<prowl.Tracker {} samples, {:.3g} to {:.3g} s>", tracker.plan().num_samples(),
                           tracker.start(), tracker.end());
      });
}

}  // namespace prowl::python

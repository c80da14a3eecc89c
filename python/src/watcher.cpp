#include "watcher.hpp"

#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/string.h>

#include <array>

#include "arrays.hpp"
#include "bindings.hpp"
#include "prowl/error.hpp"

namespace prowl::python {
namespace {

/// prowl.OnlineMoment: a moment of a run, and what its watcher asks for.
struct MomentObject {
  OnlineSample sample;
  double end = 0.0;
  std::optional<TimedCommand> command = {};
  std::optional<Eigen::Vector3d> impulse = {};
  bool stops = false;
};

template <Eigen::VectorXd OnlineSample::* vector>
Vector sample_view(nb::handle self) {
  return view(nb::cast<const MomentObject&>(self).sample.*vector, self);
}

template <Eigen::Vector3d OnlineSample::* vector>
std::array<double, 3> three(const MomentObject& moment) {
  const Eigen::Vector3d& values = moment.sample.*vector;
  return {values.x(), values.y(), values.z()};
}

}  // namespace

OnlineWatcher watcher_of(nb::callable function, double rate) {
  if (!(rate > 0.0)) throw InputError("record_rate: 0 is not allowed with watch; need > 0 Hz");
  return [=, function = keep(std::move(function)), next = 0.0](OnlineMoment& moment) mutable {
    if (moment.time < next - kTimeRounding) return;
    next += 1.0 / rate;
    const nb::gil_scoped_acquire python;
    const nb::object told = nb::cast(MomentObject{.sample = moment.sample(), .end = moment.end});
    (*function)(told);
    const auto& asked = nb::cast<const MomentObject&>(told);
    moment.command = asked.command;
    moment.impulse = asked.impulse;
    moment.stops = asked.stops;
  };
}

void bind_watcher(nb::module_& module) {
  nb::class_<MomentObject>(
      module, "OnlineMoment",
      "What run_online() tells its watcher: the robot now. Its methods request commands, pushes, the end.")
      .def_prop_ro(
          "t", [](const MomentObject& m) { return m.sample.time; }, "[s]")
      .def_ro("end", &MomentObject::end, "Time at which the run ends [s].")
      .def_prop_ro("q", &sample_view<&OnlineSample::q>, "True configuration (nq).")
      .def_prop_ro("v", &sample_view<&OnlineSample::v>, "True velocity (nv).")
      .def_prop_ro(
          "f",
          [](nb::handle self) {
            const Eigen::VectorXd& force = nb::cast<const MomentObject&>(self).sample.force;
            return Matrix(force.data(), {static_cast<std::size_t>(force.size()) / 3, 3}, self);
          },
          "Contact forces on the robot (contacts, 3), world axes [N].")
      .def_prop_ro("moves", &three<&OnlineSample::moves>, "Velocity ahead and to the left [m/s], turn rate [rad/s].")
      .def_prop_ro("commanded", &three<&OnlineSample::commanded>, "The same of the command.")
      .def(
          "command",
          [](MomentObject& m, double forward, double left, double turn, double height, const std::string& gait) {
            m.command = TimedCommand{.command = {forward, left, turn, height}, .gait = gait};
          },
          nb::arg("forward") = 0.0, nb::arg("left") = 0.0, nb::arg("turn") = 0.0, nb::arg("height") = 0.0,
          nb::arg("gait") = "", "A command from now on, as that of Controller; gait: \"\" keeps the one before.")
      .def(
          "push", [](MomentObject& m, const Eigen::Vector3d& impulse) { m.impulse = impulse; }, nb::arg("impulse"),
          "Pushes the base from now on for 0.1 s: impulse in world x, y, z [N s].")
      .def("stop", [](MomentObject& m) { m.stops = true; }, "Ends the run here.");
}

}  // namespace prowl::python

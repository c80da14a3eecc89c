#include "motion.hpp"

#include "bindings.hpp"

namespace prowl::python {

Motion::Motion(const Trajectory& trajectory)
    : t(static_cast<Eigen::Index>(trajectory.nodes.size())),
      phase(t.size()),
      q(rows_of(trajectory.nodes, &TrajectoryPoint::q)),
      v(rows_of(trajectory.nodes, &TrajectoryPoint::v)),
      a(rows_of(trajectory.nodes, &TrajectoryPoint::a)),
      tau(rows_of(trajectory.nodes, &TrajectoryPoint::tau)),
      f(rows_of(trajectory.nodes, &TrajectoryPoint::force)) {
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    const TrajectoryPoint& point = trajectory.nodes[k];
    t(k) = point.time;
    phase(k) = point.phase;
  }
}

Trajectory Motion::trajectory() const {
  Trajectory trajectory;
  for (Eigen::Index k = 0; k < t.size(); ++k) {
    trajectory.nodes.push_back({t(k), phase(k), q.row(k).transpose(), v.row(k).transpose(), a.row(k).transpose(),
                                tau.row(k).transpose(), f.row(k).transpose()});
  }
  return trajectory;
}

void bind_motion(nb::module_& module) {
  const auto motion = [](nb::handle self) -> const Motion& { return nb::cast<const Motion&>(self); };
  nb::class_<Motion>(module, "Motion", "A motion at N instants. Arrays are read-only and contiguous.")
      .def_prop_ro(
          "t", [=](nb::handle self) { return view(motion(self).t, self); }, "Times (N) [s].")
      .def_prop_ro(
          "phase", [=](nb::handle self) { return view(motion(self).phase, self); }, "Index of the phase (N), from 0.")
      .def_prop_ro(
          "q", [=](nb::handle self) { return view(motion(self).q, self); },
          "Configurations (N, nq): base position [m], quaternion x y z w, joints [rad or m].")
      .def_prop_ro(
          "v", [=](nb::handle self) { return view(motion(self).v, self); },
          "Velocities (N, nv): base twist in the base frame [m/s, rad/s], joint rates.")
      .def_prop_ro(
          "a", [=](nb::handle self) { return view(motion(self).a, self); },
          "Accelerations (N, nv): rates of the components of v [m/s^2, rad/s^2].")
      .def_prop_ro(
          "tau", [=](nb::handle self) { return view(motion(self).tau, self); }, "Torques (N, nu) [N m or N].")
      .def_prop_ro(
          "f", [=](nb::handle self) { return contacts_view(motion(self).f, self); },
          "Contact forces on the robot (N, contacts, 3), world axes [N]; zero where a contact is in the air.")
      .def("__len__", [](const Motion& m) { return m.t.size(); });
}

}  // namespace prowl::python

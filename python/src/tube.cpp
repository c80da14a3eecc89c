#include "prowl/robust/tube.hpp"

#include <fmt/format.h>

#include "bindings.hpp"
#include "plan_object.hpp"
#include "prowl/error.hpp"

namespace prowl::python {
namespace {

/// Tube of a plan as arrays, one row a sample.
struct TubeArrays {
  Eigen::VectorXd t;
  Eigen::VectorXi phase;
  RowMatrix band, cone_left, cone_needed, torque_left, torque_needed;
};

TubeArrays tube_of(const PlanObject& plan, double step) {
  constexpr double kLeast = 1e-4, kMost = 1.0;
  if (!(step >= kLeast && step <= kMost))
    throw InputError(fmt::format("step: {} is not allowed; need a number from {} to {} [s]", step, kLeast, kMost));
  const nb::gil_scoped_release others_may_run;
  const Task& task = plan.record.task;
  const MotionProblem& problem = task.problem;
  const Disturbances sizes = plan.record.robustness ? plan.record.robustness->sizes
                                                    : task.robust.value_or(default_disturbances(problem.robot));
  const Tube tube = make_tube(problem, plan.record.plan.trajectory, task.tracking, sizes, step);
  Eigen::Index count = 0;
  for (const Tube::OfPhase& phase : tube.phases) count += phase.state.cols();
  const auto contacts = static_cast<Eigen::Index>(problem.robot.contacts().size());
  TubeArrays all{.t = Eigen::VectorXd(count),
                 .phase = Eigen::VectorXi(count),
                 .band = RowMatrix(count, 2 * problem.robot.nv()),
                 .cone_left = RowMatrix(count, contacts),
                 .cone_needed = RowMatrix(count, contacts),
                 .torque_left = RowMatrix(count, problem.robot.nu()),
                 .torque_needed = RowMatrix(count, problem.robot.nu())};
  Eigen::Index row = 0;
  for (std::size_t p = 0; p < tube.phases.size(); ++p) {
    const Tube::OfPhase& phase = tube.phases[p];
    const Eigen::Index rows = phase.state.cols();
    all.t.segment(row, rows) = Eigen::Map<const Eigen::VectorXd>(phase.times.data(), rows);
    all.phase.segment(row, rows).setConstant(static_cast<int>(p));
    all.band.middleRows(row, rows) = phase.band().transpose();
    all.cone_left.middleRows(row, rows) = rows_of_contacts(problem, p, phase.cone_left).transpose();
    all.cone_needed.middleRows(row, rows) = rows_of_contacts(problem, p, phase.cone_needed()).transpose();
    all.torque_left.middleRows(row, rows) = phase.torque_left.transpose();
    all.torque_needed.middleRows(row, rows) = phase.needed.torque.transpose();
    row += rows;
  }
  return all;
}

}  // namespace

void bind_tube(nb::module_& module) {
  const auto tube = [](nb::handle self) -> const TubeArrays& { return nb::cast<const TubeArrays&>(self); };
  nb::class_<TubeArrays>(module, "Tube",
                         "How far disturbances take the closed loop from its plan, and what the limits leave for it\n"
                         "(docs/robust.md). Arrays are read-only, one row for each of N samples.")
      .def_prop_ro(
          "t", [=](nb::handle self) { return view(tube(self).t, self); }, "Times (N) [s].")
      .def_prop_ro(
          "phase", [=](nb::handle self) { return view(tube(self).phase, self); }, "Index of the phase (N), from 0.")
      .def_prop_ro(
          "band", [=](nb::handle self) { return view(tube(self).band, self); },
          "Size of the deviation that 95 % of the cases keep (N, 2 nv): base position, world axes [m]; rotation "
          "vector\n"
          "in the planned base frame [rad]; joints; velocities in the same order.")
      .def_prop_ro(
          "cone_left", [=](nb::handle self) { return view(tube(self).cone_left, self); },
          "What the plan leaves of each friction cone (N, contacts) [N]; nan in the air.")
      .def_prop_ro(
          "cone_needed", [=](nb::handle self) { return view(tube(self).cone_needed, self); },
          "What the tube and friction that may be missing need of it (N, contacts) [N].")
      .def_prop_ro(
          "torque_left", [=](nb::handle self) { return view(tube(self).torque_left, self); },
          "What the plan leaves of each torque limit (N, nu) [N m or N].")
      .def_prop_ro(
          "torque_needed", [=](nb::handle self) { return view(tube(self).torque_needed, self); },
          "What the tube needs of it (N, nu) [N m or N].")
      .def("__len__", [](const TubeArrays& t) { return t.t.size(); });
  module.def("tube", &tube_of, nb::arg("plan"), nb::arg("step") = kTubeStep,
             "The tube of a plan, at samples about `step` [s] apart, for the sizes of [robust], or else the defaults.");
}

}  // namespace prowl::python

#include "planner.hpp"

#include <fmt/format.h>
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>

#include <array>

#include "arrays.hpp"
#include "bindings.hpp"
#include "prowl/error.hpp"

namespace prowl::python {
namespace {

using Eigen::Index;
using Rows = Eigen::Ref<const RowMatrix>;
using Numbers = Eigen::Ref<const Eigen::VectorXd>;
using Gains = nb::ndarray<const double, nb::ndim<3>, nb::c_contig, nb::device::cpu>;

/// prowl.MotionRequest: a MotionRequest with copies of what it refers to.
struct RequestObject {
  explicit RequestObject(const MotionRequest& request)
      : time(request.time),
        start(request.start),
        q(request.q),
        v(request.v),
        timeline(request.timeline),
        command(request.command),
        pose(request.pose) {}

  double time, start;
  Eigen::VectorXd q, v;
  ContactTimeline timeline;
  MpcCommand command;
  Eigen::Vector3d pose;
};

/// prowl.MotionSteps: the answer, with N steps.
struct StepsObject {
  std::vector<MpcPlan::Step> steps;
  double seconds = 0.0;
};

void check_shape(const char* name, std::array<Index, 2> shape, std::array<Index, 2> needed) {
  if (shape != needed)
    throw InputError(
        fmt::format("MotionSteps: {} is {} x {}; need {} x {}", name, shape[0], shape[1], needed[0], needed[1]));
}

StepsObject steps_of(const Numbers& t, const Rows& q, const Rows& v, const Rows& tau, const Gains& gains,
                     const std::optional<Rows>& f, double seconds) {
  const Index steps = t.size() - 1, nv = v.cols(), nu = tau.cols();
  if (steps < 1) throw InputError("MotionSteps: t has too few times; need 2 or more");
  check_shape("q", {q.rows(), q.cols()}, {steps + 1, nv + 1});
  check_shape("v", {v.rows(), nv}, {steps + 1, nu + 6});
  check_shape("tau", {tau.rows(), nu}, {steps, nu});
  check_shape("a row of gains", {static_cast<Index>(gains.shape(1)), static_cast<Index>(gains.shape(2))}, {nu, 2 * nv});
  check_shape("gains", {static_cast<Index>(gains.shape(0)), 1}, {steps, 1});
  if (!(seconds >= 0.0)) throw InputError(fmt::format("MotionSteps: seconds is {}; need >= 0", seconds));
  StepsObject made;
  made.seconds = seconds;
  for (Index k = 0; k < steps; ++k) {
    MpcPlan::Step& step = made.steps.emplace_back();
    step.start = t(k);
    step.length = t(k + 1) - t(k);
    if (!(step.length > 0.0)) throw InputError("MotionSteps: t does not increase");
    step.q = q.row(k).transpose();
    step.v = v.row(k).transpose();
    step.a = (v.row(k + 1) - v.row(k)).transpose() / step.length;
    step.tau = tau.row(k).transpose();
    step.gain = Eigen::Map<const RowMatrix>(gains.data() + k * nu * 2 * nv, nu, 2 * nv);
    if (f) {
      check_shape("f", {f->rows(), f->cols()}, {steps, f->cols()});
      step.force = f->row(k).transpose();
    }
  }
  return made;
}

}  // namespace

Planner planner_of(const RobotModel& robot, nb::callable function) {
  const Index nv = robot.nv(), forces = 3 * std::ssize(robot.contacts());
  return [=, function = keep(std::move(function))](const MotionRequest& request,
                                                   std::vector<MpcPlan::Step>& steps) -> std::optional<double> {
    const nb::gil_scoped_acquire python;
    const nb::object answer = (*function)(RequestObject(request));
    if (answer.is_none()) return {};
    if (!nb::isinstance<StepsObject>(answer))
      throw InputError("planner: its answer is neither prowl.MotionSteps nor None");
    const auto& made = nb::cast<const StepsObject&>(answer);
    steps = made.steps;
    for (MpcPlan::Step& step : steps) {
      if (step.v.size() != nv)
        throw InputError(fmt::format("planner: v has {} numbers a row; need {}", step.v.size(), nv));
      if (step.force.size() == 0) step.force.setZero(forces);
      if (step.force.size() != forces)
        throw InputError(fmt::format("planner: f has {} numbers a row; need {}", step.force.size(), forces));
    }
    return made.seconds;
  };
}

void bind_planner(nb::module_& module) {
  nb::class_<RequestObject>(module, "MotionRequest",
                            "What run_online() asks a planner: a motion from the state (q, v) on at time `start`.")
      .def_ro("time", &RequestObject::time, "Time of the latest measurement [s].")
      .def_ro("start", &RequestObject::start, "Time at which the plan begins [s].")
      .def_prop_ro(
          "q", [](nb::handle self) { return view(nb::cast<const RequestObject&>(self).q, self); },
          "Configuration (nq) expected at `start`, from the measured one.")
      .def_prop_ro(
          "v", [](nb::handle self) { return view(nb::cast<const RequestObject&>(self).v, self); },
          "Velocity (nv) expected at `start`.")
      .def_prop_ro(
          "command",
          [](const RequestObject& r) {
            return std::array<double, 4>{r.command.forward, r.command.left, r.command.turn, r.command.height};
          },
          "Velocity ahead and to the left [m/s], turn rate [rad/s] and height over the standing one [m], smoothed.")
      .def_prop_ro(
          "pose", [](const RequestObject& r) { return std::array<double, 3>{r.pose.x(), r.pose.y(), r.pose.z()}; },
          "Place (x, y) [m] and heading [rad] to which the commands have led.")
      .def(
          "swing",
          [](const RequestObject& r, int foot, double t) -> std::optional<std::pair<double, double>> {
            if (foot < 0 || foot >= r.timeline.num_feet())
              throw InputError(fmt::format("foot: {}; need 0 to {}", foot, r.timeline.num_feet() - 1));
            const ContactTimeline::Swing* const swing = r.timeline.swing(foot, t);
            if (!swing) return {};
            return std::pair(swing->lift, swing->land);
          },
          nb::arg("foot"), nb::arg("t"),
          "Times of lift-off and landing [s] of the swing of a foot at time t [s]; None if it stands. Two seconds "
          "ahead "
          "are known.");
  nb::class_<StepsObject>(module, "MotionSteps", "The answer of a planner to run_online(): N steps with feedback.")
      .def(
          "__init__",
          [](StepsObject* self, const Numbers& t, const Rows& q, const Rows& v, const Rows& tau, const Gains& gains,
             const std::optional<Rows>& f,
             double seconds) { new (self) StepsObject(steps_of(t, q, v, tau, gains, f, seconds)); },
          nb::arg("t"), nb::arg("q"), nb::arg("v"), nb::arg("tau"), nb::arg("gains"), nb::arg("f") = nb::none(),
          nb::kw_only(), nb::arg("seconds") = 0.0,
          "t: times of nodes (N + 1) [s]. q, v: states there (N + 1, nq and nv). tau: torques of the steps (N, nu).\n"
          "gains (N, nu, 2 nv) times deviation are added to tau: base displacement in world axes [m], rotation\n"
          "vector in base axes [rad], joints, velocities. f: contact forces (N, 3 each). seconds: computing time [s].")
      .def("__len__", [](const StepsObject& s) { return s.steps.size(); });
}

}  // namespace prowl::python

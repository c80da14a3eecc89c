#include <fmt/format.h>
#include <nanobind/eigen/dense.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/filesystem.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <mutex>

#include "arrays.hpp"
#include "bindings.hpp"
#include "module_files.hpp"
#include "planner.hpp"
#include "prowl/error.hpp"
#include "prowl/mpc/mpc_controller.hpp"
#include "prowl/mpc/plan_executor.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/online/online_json.hpp"
#include "prowl/online/online_run.hpp"
#include "prowl/online/random_events.hpp"
#include "prowl/online/script_file.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "prowl/text/option_check.hpp"
#include "pushes.hpp"
#include "screen/online_summary.hpp"
#include "signals.hpp"
#include "watcher.hpp"

namespace prowl::python {
namespace {

using State = Eigen::Ref<const Eigen::VectorXd>;

/// prowl.Controller: an MpcController that plans every `period`.
class ControllerObject {
 public:
  ControllerObject(const RobotModel& robot, const std::string& gait, double period, double delay, double friction)
      : robot_(robot),
        period_(period),
        controller_(robot_, options(delay, friction), standing_on_ground(robot_), Eigen::VectorXd::Zero(robot.nv()),
                    0.0),
        executor_(robot_, controller_.latest()) {
    check_option(period >= 1e-3 && period <= 0.2, "period", period, "0.001 to 0.2 s");
    check_option(delay <= LatestPlans::kLongestDelay * period, "delay", delay,
                 fmt::format("at most seven periods, {:g} s", LatestPlans::kLongestDelay * period));
    follow(gait);
  }

  void follow(const std::string& gait) {
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard guard(planning_);
    const double height = controller_.standing_posture().z();
    controller_.follow(stepping_pattern(robot_, controller_.feet(), height, gait));
  }
  std::array<double, 4> command(double forward, double left, double turn, double height) {
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard guard(planning_);
    const MpcCommand kept = controller_.command({forward, left, turn, height});
    return {kept.forward, kept.left, kept.turn, kept.height};
  }
  bool update(double t, const State& q, const State& v, const std::optional<std::vector<bool>>& touches) {
    check_state(q, v);
    if (touches && touches->size() != controller_.feet().size())
      throw InputError(
          fmt::format("touches: {} values; need one for each of {} feet", touches->size(), controller_.feet().size()));
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard guard(planning_);
    if (touches) controller_.feel_contacts(*touches, t);
    if (std::isfinite(t)) next_ = t + period_;
    const bool has_plan = controller_.update(q, v, t);
    if (has_plan) executor_.offer(controller_.latest());
    return has_plan;
  }
  Array torque(double t, const State& q, const State& v) {
    check_state(q, v);
    Eigen::VectorXd tau(robot_.nu());
    executor_.torque(t, q, v, tau);
    return new_array(tau);
  }
  long failed() {
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard guard(planning_);
    return controller_.counters().failed;
  }
  Array step(double t, const State& q, const State& v, const std::optional<std::vector<bool>>& touches) {
    if (is_due(t)) update(t, q, v, touches);
    return torque(t, q, v);
  }

  const MpcController& controller() const { return controller_; }
  double period() const { return period_; }

 private:
  static MpcOptions options(double delay, double friction) {
    MpcOptions options;
    options.delay = delay;
    options.friction = friction;
    return options;
  }
  void check_state(const State& q, const State& v) const {
    if (q.size() == robot_.nq() && v.size() == robot_.nv()) return;
    throw InputError(
        fmt::format("q, v: {} and {} numbers; need {} and {}", q.size(), v.size(), robot_.nq(), robot_.nv()));
  }

  bool is_due(double t) {
    const nb::gil_scoped_release others_may_run;
    const std::lock_guard guard(planning_);
    return t >= next_ - kTimeRounding;
  }

  RobotModel robot_;
  double period_, next_ = 0.0;
  std::mutex planning_;  ///< of controller_ and next_, but not of what never changes
  MpcController controller_;
  PlanExecutor executor_;
};

/// prowl.OnlineRun: results as arrays, one row per sample.
struct OnlineObject {
  OnlineObject(RobotModel of, OnlineOptions asked, OnlineResult made)
      : robot(std::move(of)), options(std::move(asked)), result(std::move(made)) {
    const std::vector<OnlineSample>& samples = result.samples;
    q = rows_of(samples, &OnlineSample::q);
    v = rows_of(samples, &OnlineSample::v);
    f = rows_of(samples, &OnlineSample::force);
    t.resize(q.rows());
    moves.resize(q.rows(), 3);
    commanded.resize(q.rows(), 3);
    for (Eigen::Index k = 0; k < t.size(); ++k) {
      const OnlineSample& sample = samples[static_cast<std::size_t>(k)];
      t(k) = sample.time;
      moves.row(k) = sample.moves.transpose();
      commanded.row(k) = sample.commanded.transpose();
    }
    times = Eigen::Map<const Eigen::VectorXd>(result.times.data(), std::ssize(result.times));
  }

  RobotModel robot;
  OnlineOptions options;
  OnlineResult result;
  Eigen::VectorXd t, times;
  RowMatrix q, v, f, moves, commanded;
};

std::shared_ptr<OnlineObject> run(const RobotModel& robot, const std::string& gait,
                                  const std::array<double, 3>& command,
                                  const std::optional<std::filesystem::path>& script, double duration,
                                  const std::vector<PushArgument>& pushes, double kicks, double random_commands,
                                  double period, double budget, double delay, std::optional<double> friction,
                                  double mass, double noise, bool perfect_state, std::uint64_t seed, double record_rate,
                                  const std::optional<nb::callable>& planner, const std::string& late,
                                  const std::optional<nb::callable>& watch, const Folders& package_dirs) {
  OnlineOptions options;
  if (planner) options.planner = planner_of(robot, *planner);
  options.late = late_plans_named(late);
  options.gait = gait;
  options.duration = duration;
  options.period = period;
  options.budget = budget;
  options.simulation.delay = delay;
  options.simulation.physics.friction = friction;
  options.simulation.physics.mass_scale = mass;
  options.simulation.physics.collisions = collision_shapes(robot, package_search(package_dirs));
  options.simulation.noise_scale = noise;
  options.simulation.perfect_state = perfect_state;
  options.simulation.seed = seed;
  options.simulation.record_rate = record_rate;
  options.simulation.pushes = pushes_of(pushes, Push{}.duration);
  const bool has_command = command != std::array<double, 3>{}, has_random = random_commands != 0.0;
  if (has_command + has_random + script.has_value() > 1)
    throw InputError("command, random_commands, script: need one of them at most");
  if (kicks != 0.0) add_kicks(robot, kicks, options);
  if (script) {
    add_script(read_script(read_text_file(script->string())), options);
  } else if (has_random) {
    add_random_commands(random_commands, options);
  } else if (has_command) {  // else a watcher commands
    options.commands.push_back({kFirstCommand, {command[0], command[1], command[2], 0.0}, {}});
  }
  const OnlineWatcher watcher = watch ? watcher_of(*watch, record_rate) : OnlineWatcher();
  constexpr int kTicks = 50;
  const nb::gil_scoped_release others_may_run;
  OnlineResult result = run_online(robot, options, [&, check = SignalCheck(kTicks)](OnlineMoment& moment) mutable {
    check();
    if (watcher) watcher(moment);
  });
  return std::make_shared<OnlineObject>(robot, std::move(options), std::move(result));
}

template <RowMatrix OnlineObject::* rows>
Matrix rows_view(nb::handle self) {
  return view(nb::cast<const OnlineObject&>(self).*rows, self);
}

void bind_controller(nb::module_& module) {
  nb::class_<ControllerObject>(
      module, "Controller",
      "Model predictive control of a robot that steps in a gait on flat ground (docs/mpc.md). One thread may plan, "
      "another ask for torques. It begins in its "
      "standing posture at time 0.")
      .def(nb::init<const RobotModel&, const std::string&, double, double, double>(), nb::arg("robot"),
           nb::arg("gait") = "trot", nb::kw_only(), nb::arg("period") = 0.01, nb::arg("delay") = 0.012,
           nb::arg("friction") = MpcOptions{}.friction,
           "period: between two plans [s]. delay: from a measured state to the time at which its plan acts [s]. "
           "friction: coefficient of the ground that plans may use.")
      .def("follow", &ControllerObject::follow, nb::arg("gait"),
           "From the end of the horizon on: \"stand\", \"trot\", \"walk\" or \"pace\".")
      .def("command", &ControllerObject::command, nb::arg("forward") = 0.0, nb::arg("left") = 0.0,
           nb::arg("turn") = 0.0, nb::arg("height") = 0.0,
           "Velocities [m/s], turn rate [rad/s] and height over the standing one [m]. Returns what is followed: "
           "within what the legs allow, without velocity while the robot stands.")
      .def("update", &ControllerObject::update, nb::arg("t"), nb::arg("q"), nb::arg("v"),
           nb::arg("touches") = nb::none(),
           "Plans from the state measured at t; touches: whether each foot touches the ground. False if there is no "
           "new plan: the last one goes on.")
      .def("torque", &ControllerObject::torque, nb::arg("t"), nb::arg("q"), nb::arg("v"),
           "Torques (nu) of the plan at t with its gains, within the limits [N m].")
      .def("step", &ControllerObject::step, nb::arg("t"), nb::arg("q"), nb::arg("v"), nb::arg("touches") = nb::none(),
           "update() if a period has passed since the last one, then torque().")
      .def_prop_ro("period", &ControllerObject::period, "[s]")
      .def_prop_ro(
          "standing", [](const ControllerObject& c) { return new_array(c.controller().standing_posture()); },
          nb::rv_policy::move, "Configuration (nq) in which it begins.")
      .def_prop_ro(
          "feet", [](const ControllerObject& c) { return c.controller().feet(); },
          "Indices of the contacts of each foot.")
      .def_prop_ro("failed", &ControllerObject::failed, "Number of updates without a new plan.");
}

}  // namespace

void bind_online(nb::module_& module) {
  bind_controller(module);
  const auto result = [](const OnlineObject& o) -> const OnlineResult& { return o.result; };
  nb::class_<OnlineObject>(module, "OnlineRun",
                           "A run under online control in MuJoCo (docs/mpc.md), at S samples. Arrays are read-only.")
      .def_prop_ro("success", [=](const OnlineObject& o) { return result(o).success(); })
      .def_prop_ro(
          "failures", [=](const OnlineObject& o) { return result(o).failures; }, "Violated criteria, in words.")
      .def_prop_ro(
          "notes", [=](const OnlineObject& o) { return result(o).notes; }, "Commands that were out of range, in words.")
      .def_prop_ro(
          "end_time", [=](const OnlineObject& o) { return result(o).end_time; }, "[s]")
      .def_prop_ro(
          "velocity_error", [=](const OnlineObject& o) { return result(o).velocity_error; },
          "RMS of the base's horizontal velocity from the command [m/s].")
      .def_prop_ro(
          "t", [](nb::handle self) { return view(nb::cast<const OnlineObject&>(self).t, self); }, "Times (S) [s].")
      .def_prop_ro("q", &rows_view<&OnlineObject::q>, "True configurations (S, nq).")
      .def_prop_ro("v", &rows_view<&OnlineObject::v>, "True velocities (S, nv).")
      .def_prop_ro(
          "f", [](nb::handle self) { return contacts_view(nb::cast<const OnlineObject&>(self).f, self); },
          "Contact forces on the robot (S, contacts, 3), world axes [N].")
      .def_prop_ro("moves", &rows_view<&OnlineObject::moves>,
                   "Velocity ahead and to the left, turn rate (S, 3) [m/s, rad/s].")
      .def_prop_ro("commanded", &rows_view<&OnlineObject::commanded>, "The same of the command (S, 3).")
      .def_prop_ro(
          "plan_times", [](nb::handle self) { return view(nb::cast<const OnlineObject&>(self).times, self); },
          "CPU time of each plan [s].")
      .def(
          "summary", [](const OnlineObject& o) { return online_summary(o.robot, o.options, o.result); },
          "Text that `prowl mpc` prints.")
      .def(
          "to_json", [](const OnlineObject& o) { return online_json(o.robot, o.options, o.result); },
          "Text of `prowl mpc --json`.")
      .def("__repr__", [](const OnlineObject& o) {
        return fmt::format("<prowl.OnlineRun {}: {}, {:.3g} s>", o.robot.name(),
                           o.result.success() ? "success" : o.result.failures.front(), o.result.end_time);
      });
  const OnlineOptions defaults;
  module.def(
      "run_online", &run, nb::arg("robot"), nb::kw_only(), nb::arg("gait") = defaults.gait,
      nb::arg("command") = std::array<double, 3>{0.0, 0.0, 0.0}, nb::arg("script") = nb::none(),
      nb::arg("duration") = defaults.duration, nb::arg("pushes") = std::vector<PushArgument>{}, nb::arg("kicks") = 0.0,
      nb::arg("random_commands") = 0.0, nb::arg("period") = defaults.period, nb::arg("budget") = defaults.budget,
      nb::arg("delay") = defaults.simulation.delay, nb::arg("friction") = nb::none(),
      nb::arg("mass") = defaults.simulation.physics.mass_scale, nb::arg("noise") = defaults.simulation.noise_scale,
      nb::arg("perfect_state") = false, nb::arg("seed") = defaults.simulation.seed, nb::arg("record_rate") = 100.0,
      nb::arg("planner") = nb::none(), nb::arg("late") = "act", nb::arg("watch") = nb::none(),
      nb::arg("package_dirs") = Folders{},
      "Runs a robot under online control in MuJoCo, like `prowl mpc`. Deterministic.\n\n"
      "command: velocity ahead and to the left [m/s], turn rate [rad/s]. script: a file with commands, gaits and\n"
      "pushes (docs/mpc.md#a-script), in place of command. pushes: (time [s], impulse [N s] in\n"
      "world x, y, z) on the base, each 0.1 s long. kicks: one every 2 s in a random direction, impulse over\n"
      "mass [m/s]. random_commands: largest random velocity and turn rate, in place of command. budget: from a\n"
      "measured state until its plan acts [s]. friction, mass: of the simulated world, as in simulate().\n\n"
      "planner: a function MotionRequest -> MotionSteps or None, in the place of Prowl's controller. late: what\n"
      "becomes of plans that take longer than the budget. \"act\": they act at its end all the same; \"drop\":\n"
      "they are lost; \"wait\": they act when they are ready, and the next state is measured then. watch: a\n"
      "function that is called with an OnlineMoment at each sample; it may ask for commands and pushes.");
}

}  // namespace prowl::python

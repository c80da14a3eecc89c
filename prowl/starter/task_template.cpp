#include <fmt/format.h>
#include <fmt/ranges.h>

#include "prowl/model/configuration.hpp"
#include "prowl/motion/gait.hpp"
#include "prowl/starter/new_task.hpp"
#include "prowl/task_file/toml/toml_text.hpp"

namespace prowl {
namespace {

constexpr const char* kTaskHead = R"(# {what}
# Written by `prowl new task` for {robot}: {mass:.1f} kg, base height {height:.2f} m. All keys: docs/task-file.md.
name = "{kind}"
robot = {file}   # relative to this file

# Surfaces that contacts may touch: planes and patches. By default level ground at z = 0.
[[surface]]
name = "floor"
friction = 0.5   # Coulomb coefficient

)";

constexpr const char* kOnePhase = R"(# Phases: times with one set of contacts. Here all contacts hold all the time.
[[phase]]
contacts = "all"
duration_s = {duration:.1f}

)";

constexpr const char* kStepsText =
    R"(# Phases: times with one set of contacts. Contacts open and land between phases.
[[phase]]
name = "shift"   # the weight shifts over the other feet
contacts = "all"
duration_s = {shift}

[[phase]]
name = "swing"
contacts = [{stay}]
duration_s = {swing}

[[phase]]
name = "settle"
contacts = [{landed}, {stay}]
duration_s = {settle}

)";

constexpr const char* kGait =
    R"(# A gait: feet swing in turn while the others stand. The optimiser chooses the footholds. Other kinds: {others}.
[gait]
kind = "{kind}"
strides = {strides}
speed_mps = {speed:.3g}   # forward; heading_rad turns the direction
# By the robot's height and the speed, unless given: stride_s = {stride:.2f}, duty_factor = {duty:.3g}

)";

constexpr const char* kGoalsNote =
    R"(# Goals hold exactly; all else is free. Displacements are from the start: forward, left, up [m].
)";

constexpr const char* kAtRest = R"(base_linear_velocity_mps = [0, 0, 0]   # at rest
base_angular_velocity_radps = [0, 0, 0]
)";

constexpr const char* kCostNote =
    R"(# Running cost: half the integral of weight x difference^2, from the start posture and the torques that hold it. Mostly
# acceleration: smooth motions have small mesh errors. The weight of torque scales with 1 / mass^2 of the robot.
[cost]
)";

constexpr const char* kCostOfPoints = R"(base_position = 0.1
base_orientation = 0.1
joint_position = 0.1
base_linear_velocity = 0.1
base_angular_velocity = 0.1
joint_velocity = 0.1
base_linear_acceleration = 1.0
base_angular_acceleration = 1.0
joint_acceleration = 0.01
)";

constexpr const char* kCostOfSoles = R"(joint_position = 1.0   # keeps the arms in place
base_orientation = 1.0
joint_velocity = 0.1
base_linear_velocity = 0.1
base_angular_velocity = 0.1
base_linear_acceleration = 1.0
base_angular_acceleration = 1.0
joint_acceleration = 0.02
)";

constexpr const char* kCostOfStepOnPoints =
    R"(time = 0.2   # the optimiser chooses the durations of the phases, within their bounds
joint_velocity = 0.1
base_linear_velocity = 0.1
base_angular_velocity = 0.1
base_linear_acceleration = 1.0
base_angular_acceleration = 1.0
joint_acceleration = 0.02
)";

constexpr const char* kCostOfGait = R"(joint_position = 1.0
joint_velocity = 1.0
base_orientation = 10.0
base_linear_velocity = 1.0
base_angular_velocity = 1.0
base_linear_acceleration = 0.1
base_angular_acceleration = 0.1
joint_acceleration = {joints}
)";

constexpr int kStrides = 2;

std::string vector(const Eigen::Vector3d& v) {
  return fmt::format("[{:.6g}, {:.6g}, {:.6g}]", v.x() + 0.0, v.y() + 0.0, v.z() + 0.0);
}

std::string quoted(const std::vector<std::string>& names) {
  std::vector<std::string> result;
  for (const std::string& name : names) result.push_back('"' + name + '"');
  return fmt::format("{}", fmt::join(result, ", "));
}

std::string what(const NewTask& task) {
  switch (task.kind) {
    case NewTaskKind::hold: return "Goal and cost keep the robot still.";
    case NewTaskKind::stand: return "The base moves and turns a little, feet in place.";
    case NewTaskKind::crouch:
      return fmt::format("Crouch: the base {:.0f} cm down and back up, feet in place.", 100.0 * task.depth);
    case NewTaskKind::step:
      return fmt::format("A step of {:.0f} cm forward with {}.", 100.0 * task.length,
                         task.soles ? "the left foot" : task.swing.front());
    case NewTaskKind::gait:
      return fmt::format("{} strides at {:.2g} m/s, gait: {}.", kStrides, task.speed, task.pattern);
  }
  return "";
}

std::string step_phases(const NewTask& task) {
  // Only the first corner of a sole gets a foothold: the foot fixes the others.
  std::string landed = fmt::format("{{ contact = \"{}\", place_m = {} }}", task.swing.front(), vector(task.foothold));
  for (std::size_t i = 1; i < task.swing.size(); ++i) landed += ", \"" + task.swing[i] + '"';
  const auto phases = [&](const char* shift, const char* swing, const char* settle) {
    return fmt::format(fmt::runtime(kStepsText), fmt::arg("stay", quoted(task.stay)), fmt::arg("landed", landed),
                       fmt::arg("shift", shift), fmt::arg("swing", swing), fmt::arg("settle", settle));
  };
  return task.soles ? phases("1.2", "0.8", "1.2")
                    : phases("[0.3, 1.2]   # the optimiser chooses", "[0.25, 0.6]", "[0.3, 1.2]");
}

std::string gait(const NewTask& task) {
  const GaitPattern& pattern = gait_pattern(task.pattern);
  std::vector<std::string> others;
  for (const GaitPattern& other : gait_patterns()) {
    if (other.name != task.pattern) others.push_back(other.name);
  }
  return fmt::format(fmt::runtime(kGait), fmt::arg("others", fmt::join(others, ", ")), fmt::arg("kind", task.pattern),
                     fmt::arg("strides", kStrides), fmt::arg("speed", task.speed),
                     fmt::arg("stride", pattern.default_stride(task.height, task.speed)),
                     fmt::arg("duty", pattern.default_duty_factor(task.height, task.speed)));
}

/// Roll, pitch and yaw of `rpy` followed by `turn` about the world's axes [rad].
Eigen::Vector3d turned(const Eigen::Vector3d& rpy, const Eigen::Vector3d& turn) {
  return rpy_from_rotation(rotation_from_rpy(turn) * rotation_from_rpy(rpy));
}

std::string goals(const NewTask& task, const Eigen::Vector3d& rpy, double duration) {
  const auto goal = [&](const std::string& when, const Eigen::Vector3d& displacement, const Eigen::Vector3d& turn,
                        bool at_rest) {
    return fmt::format("[[goal]]\n{}base_displacement_m = {}\nbase_rpy_rad = {}\n{}\n", when, vector(displacement),
                       vector(turn), at_rest ? kAtRest : "");
  };
  const std::string end = fmt::format("time_s = {:.1f}\n", duration);
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  switch (task.kind) {
    case NewTaskKind::hold: return goal(end, none, rpy, true);
    case NewTaskKind::stand: return goal(end, task.shift, turned(rpy, task.turn), true);
    case NewTaskKind::crouch:
      return goal(fmt::format("time_s = {:.1f}\n", 0.5 * duration), {0.0, 0.0, -task.depth}, rpy, false) +
             goal(end, none, rpy, true);
    case NewTaskKind::step:
      return goal("phase = \"settle\"   # at its end\n", {(task.soles ? 0.5 : 0.25) * task.length, 0.0, 0.0}, rpy,
                  true);
    case NewTaskKind::gait: break;  // its stride length determines the goal
  }
  return "";
}

std::string cost(const NewTask& task) {
  std::string text = kCostNote;
  if (task.kind == NewTaskKind::step && task.soles)
    text += "force = 1e-6   # selects the smallest of the non-unique forces at the corners of a sole\n";
  // A trot needs quick legs; slower gaits get smoother joints and smaller mesh errors.
  text += task.kind == NewTaskKind::gait
              ? fmt::format(fmt::runtime(kCostOfGait), fmt::arg("joints", task.pattern == "trot" ? 0.001 : 0.005))
          : task.soles                     ? kCostOfSoles
          : task.kind == NewTaskKind::step ? kCostOfStepOnPoints
                                           : kCostOfPoints;
  return text + fmt::format("torque = {:g}\n", task.torque_weight);
}

}  // namespace

std::string task_template(const NewTask& task, const RobotModel& robot, const std::string& robot_file) {
  const double duration = task.kind == NewTaskKind::hold ? 1.0 : task.soles ? 2.4 : 2.0;
  std::string text = fmt::format(fmt::runtime(kTaskHead), fmt::arg("what", what(task)), fmt::arg("robot", robot.name()),
                                 fmt::arg("mass", robot.mass()), fmt::arg("height", task.height),
                                 fmt::arg("kind", kind_name(task)), fmt::arg("file", toml_string(robot_file)));
  if (task.kind == NewTaskKind::gait) return text + gait(task) + cost(task);
  text += task.kind == NewTaskKind::step ? step_phases(task)
                                         : fmt::format(fmt::runtime(kOnePhase), fmt::arg("duration", duration));
  text += kGoalsNote;
  text += goals(task, robot.description().nominal_base_rpy, duration);
  return text + cost(task);
}

}  // namespace prowl

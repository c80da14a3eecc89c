#include "prowl/plan_folder/simulation_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "prowl/plan_folder/simulation_parts.hpp"
#include "prowl/simulation/collision_shapes.hpp"
#include "prowl/simulation/judge.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kSimulationEngine = "mujoco";

Json options_json(const SimulationOptions& options) {
  Json json = {{"seed", options.seed},
               {"control_rate_Hz", options.control_rate},
               {"step_s", options.physics.step},
               {"noise",
                {{"scale", options.noise_scale},
                 {"encoder_rad", options.noise.encoder},
                 {"gyro_radps", options.noise.gyro},
                 {"accelerometer_mps2", options.noise.accelerometer}}},
               {"delay_s", options.delay},
               {"bandwidth_Hz", options.bandwidth},
               {"perfect_state", options.perfect_state},
               {"open_loop", options.open_loop},
               {"mass_scale", options.physics.mass_scale},
               {"friction", nullptr},
               {"pushes", Json::array()}};
  if (options.physics.friction) json["friction"] = *options.physics.friction;
  const PhysicsOptions& physics = options.physics;
  json["world"] = {{"body_scales", physics.body_scales},
                   {"base_center_m", vector_json(physics.base_center)},
                   {"friction_scale", physics.friction_scale},
                   {"ground_height_m", options.ground.height},
                   {"ground_tilt_rad", vector_json(options.ground.tilt)},
                   {"unknown_delay_s", options.unknown_delay},
                   {"unknown_noise", options.unknown_noise}};
  if (const auto& start = options.start) {
    json["world"]["start"] = {{"base_m_rad", vector_json(start->base)},
                              {"twist_mps_radps", vector_json(start->twist)},
                              {"joints_rad", vector_json(start->joints)}};
  }
  for (const Push& push : options.pushes) {
    json["pushes"].push_back(
        {{"impulse_Ns", vector_json(push.impulse)}, {"time_s", push.time}, {"duration_s", push.duration}});
  }
  return json;
}

TorqueUse torque_use(const SimulationResult& result) {
  return {result.largest_torque_share, result.largest_torque_joint, result.saturated, result.positive_work};
}

std::vector<std::string> csv_columns(const RobotModel& robot) {
  std::vector<std::string> columns = {"time_s"};
  for (const char* kind : {"ref", "true", "seen"}) {
    for (const char* name : {"px_m", "py_m", "pz_m", "qx", "qy", "qz", "qw"})
      columns.push_back(fmt::format("{}_base_{}", kind, name));
    for (const auto& joint : robot.joint_names()) columns.push_back(fmt::format("{}_q_{}_rad", kind, joint));
    for (const char* name : {"vx_mps", "vy_mps", "vz_mps", "wx_radps", "wy_radps", "wz_radps"})
      columns.push_back(fmt::format("{}_base_{}", kind, name));
    for (const auto& joint : robot.joint_names()) columns.push_back(fmt::format("{}_v_{}_radps", kind, joint));
  }
  for (const auto& joint : robot.joint_names()) columns.push_back(fmt::format("tracked_q_{}_rad", joint));
  for (const char* kind : {"feedforward", "feedback", "tau"}) {
    for (const auto& joint : robot.joint_names()) columns.push_back(fmt::format("{}_{}_Nm", kind, joint));
  }
  for (const ContactPoint& contact : robot.contacts()) {
    columns.push_back("touch_" + contact.name);
    for (const char axis : {'x', 'y', 'z'}) columns.push_back(fmt::format("f_{}_{}_N", contact.name, axis));
  }
  return columns;
}

}  // namespace

std::string simulation_summary(const PlanRecord& plan, const SimulationRecord& record) {
  const SimulationResult& result = record.result;
  const SimulationOptions& options = record.options;
  const MotionProblem& problem = plan.task.problem;
  std::string text =
      fmt::format("{} {} in MuJoCo, {}, {}: {}\n", problem.robot.name(), problem.name,
                  options.open_loop ? "open loop" : "closed loop",
                  options.perfect_state ? "true state" : "estimated state", result.success() ? "success" : "FAILED");
  text +=
      fmt::format("  seed {}, control at {:g} Hz, delay {:g} ms, sensor noise x {:g}{}{}\n", options.seed,
                  options.control_rate, 1e3 * options.delay, options.perfect_state ? 0.0 : options.noise_scale,
                  options.physics.mass_scale != 1.0 ? fmt::format(", masses x {:g}", options.physics.mass_scale) : "",
                  options.physics.friction ? fmt::format(", friction {:g}", *options.physics.friction) : "");
  if (!options.physics.body_scales.empty())
    text += fmt::format("  case of a sweep: {}\n", world_in_words(problem.robot, options));
  if (options.bandwidth > 0.0) text += fmt::format("  actuator bandwidth {:g} Hz\n", options.bandwidth);
  for (const Push& push : options.pushes) {
    text += fmt::format("  push of {:.3g} N s along [{:.3g}, {:.3g}, {:.3g}] from {:.3g} s for {:.3g} s\n",
                        push.impulse.norm(), push.impulse.x(), push.impulse.y(), push.impulse.z(), push.time,
                        push.duration);
  }
  if (options.physics.collisions) {
    for (const std::string& link : options.physics.collisions->unreadable)
      text += fmt::format("  collisions of this link are not judged: {}\n", link);
  }
  for (const std::string& failure : result.failures) text += fmt::format("  failed: {}\n", failure);
  text += error_heading();
  text += error_line("base position", result.base_position, 0.01, "cm ");
  text += error_line("base orientation", result.base_angle, kDegree, "deg");
  text += error_line("worst joint", result.joints, kDegree, "deg");
  if (!options.perfect_state) {
    text += error_line("estimate of position", result.estimated_position, 0.01, "cm ");
    text += error_line("estimate of orientation", result.estimated_angle, kDegree, "deg");
    text += error_line("estimate of velocity", result.estimated_velocity, 0.01, "cm/s");
  }
  text += "  slip        ";
  for (std::size_t c = 0; c < result.slip.size(); ++c) {
    text += fmt::format("{}{} {:.1f} mm", c > 0 ? ", " : "", problem.robot.contacts()[c].name, 1e3 * result.slip[c]);
  }
  text += '\n';
  text += torque_line(torque_use(result));
  double late = 0.0, off = 0.0;
  int missing = 0;
  for (const ContactSwitch& change : result.switches) {
    if (std::isnan(change.measured)) {
      ++missing;
      continue;
    }
    late = std::max(late, std::abs(change.measured - change.planned));
    off = std::max(off, change.off);
  }
  if (!result.switches.empty()) {
    text += fmt::format(
        "  contacts    {} landings and lift-offs, at most {:.0f} ms from the plan{}; at most {:.1f} cm from the "
        "foothold\n",
        result.switches.size(), 1e3 * late, missing > 0 ? fmt::format(", {} missing", missing) : "", 100 * off);
  }
  return text;
}

std::string simulation_json(const PlanRecord& plan, const SimulationRecord& record) {
  const SimulationResult& result = record.result;
  const RobotModel& robot = plan.task.problem.robot;
  Json json =
      verdict_json(plan, {kSimulationEngine, result.failures, to_string(result.end), result.end_time, result.phase});
  const SuccessCriteria& criteria = plan.task.success;
  json["criteria"]["slip_m"] = allowed_distance(robot, criteria);
  json["criteria"]["delay_s"] = criteria.delay;
  json["criteria"]["delay_share_of_swing"] = criteria.delay_share;
  json["criteria"]["at_limit_share_of_time"] = criteria.at_limit;
  json.update({{"base_position_m", error_json(result.base_position)},
               {"base_angle_rad", error_json(result.base_angle)},
               {"joints_rad", error_json(result.joints)},
               {"estimated_position_m", error_json(result.estimated_position)},
               {"estimated_angle_rad", error_json(result.estimated_angle)},
               {"estimated_velocity_mps", error_json(result.estimated_velocity)},
               {"estimated_joint_rate_radps_rms", result.estimated_joint_rate},
               {"torque", torque_json(torque_use(result))}});
  for (std::size_t c = 0; c < result.slip.size(); ++c) json["slip_m"][robot.contacts()[c].name] = result.slip[c];
  json["switches"] = Json::array();
  for (const ContactSwitch& change : result.switches) {
    Json entry = {{"contact", robot.contacts()[change.contact].name},
                  {"lands", change.lands},
                  {"planned_s", change.planned},
                  {"measured_s", nullptr}};
    if (std::isfinite(change.measured)) {
      entry["measured_s"] = change.measured;
      if (change.lands) entry["off_m"] = change.off;
      if (change.lands) entry["on_its_surface"] = change.on_its_surface;
    }
    json["switches"].push_back(entry);
  }
  json["goals"] = Json::array();
  for (const GoalError& goal : result.goals)
    json["goals"].push_back(
        {{"goal", goal.name}, {"position_m", goal.position}, {"angle_rad", goal.angle}, {"joint_rad", goal.joint}});
  json["flights"] = Json::array();
  for (const FlightHeight& flight : result.flights)
    json["flights"].push_back({{"phase", flight.phase}, {"missing_height_m", flight.missing}});
  json["touches"] = result.touches;
  json["options"] = options_json(record.options);
  const auto& collisions = record.options.physics.collisions;
  json["unreadable_collisions"] = collisions ? collisions->unreadable : std::vector<std::string>();
  json["left_out_of_collisions"] = collisions ? collisions->left_out : std::vector<std::string>();
  json["versions"] = {{"MuJoCo", Physics::version()}};
  return json_text(json);
}

std::string simulation_csv(const RobotModel& robot, const std::vector<SimulationSample>& samples) {
  std::string text = fmt::format("{}\n", fmt::join(csv_columns(robot), ","));
  std::vector<double> row;
  const auto append = [&row](const Eigen::VectorXd& values) { row.insert(row.end(), values.begin(), values.end()); };
  for (const SimulationSample& sample : samples) {
    row = {sample.time};
    for (const Eigen::VectorXd* part :
         {&sample.q_ref, &sample.v_ref, &sample.q, &sample.v, &sample.q_seen, &sample.v_seen}) {
      append(*part);
    }
    append(sample.q_tracked.tail(robot.nu()));
    for (const Eigen::VectorXd* part : {&sample.feedforward, &sample.feedback, &sample.tau}) append(*part);
    for (const ContactReading& contact : sample.contacts) {
      row.push_back(contact.touches ? 1.0 : 0.0);
      append(contact.force);
    }
    fmt::format_to(std::back_inserter(text), "{:.9g}\n", fmt::join(row, ","));
  }
  return text;
}

void write_simulation(const std::filesystem::path& directory, const PlanRecord& plan, const SimulationRecord& record) {
  write_simulation_files(directory, simulation_json(plan, record),
                         simulation_csv(plan.task.problem.robot, record.result.samples));
}

}  // namespace prowl

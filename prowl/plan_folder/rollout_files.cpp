#include "prowl/plan_folder/rollout_files.hpp"

#include <fmt/format.h>

#include "prowl/plan_folder/simulation_parts.hpp"
#include "prowl/simulation/judge.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kRolloutEngine = "rollout";

const TrackingPlan::Segment& last_segment(const Tracker& tracker, const Rollout& rollout) {
  const int segment = rollout.samples.empty() ? 0 : rollout.samples.back().segment;
  return tracker.plan().segments[segment];
}

TorqueUse torque_use(const RolloutMeasures& measures) {
  return {measures.largest_torque_share, measures.largest_torque_joint, measures.saturated, measures.positive_work};
}

double control_rate(const RolloutOptions& options) {
  return options.control_step > 0.0 ? 1.0 / options.control_step : 0.0;
}

std::string offset_text(const RolloutRecord& record) {
  const Eigen::Vector3d &p = record.base_offset, rpy = record.base_offset_rpy / kDegree;
  if (p.isZero(0.0) && rpy.isZero(0.0)) return "start as planned";
  return fmt::format("base displaced at the start by ({:g}, {:g}, {:g}) cm, roll {:.3g}, pitch {:.3g}, yaw {:.3g} deg",
                     100 * p.x(), 100 * p.y(), 100 * p.z(), rpy.x(), rpy.y(), rpy.z());
}

Json load_json(const ContactLoad& load) {
  if (!load.stood) return nullptr;
  return {{"least_normal_force_N", load.least_normal_force},
          {"least_normal_force_time_s", load.least_normal_time},
          {"beyond_friction_cone_N", load.beyond_cone},
          {"beyond_friction_cone_time_s", load.beyond_cone_time}};
}

/// The sample in the form of the other engine.
SimulationSample as_simulation_sample(const RobotModel& robot, const Tracker& tracker, const RolloutRecord& record,
                                      const RolloutSample& from) {
  SimulationSample sample;
  sample.time = from.time;
  sample.q_ref.resize(robot.nq());
  sample.v_ref.resize(robot.nv());
  tracker.reference(from.time, sample.q_ref, sample.v_ref);
  sample.q_tracked = sample.q_ref;
  sample.q = sample.q_seen = from.q;
  sample.v = sample.v_seen = from.v;
  sample.feedforward.resize(robot.nu());
  sample.feedback.setZero(robot.nu());
  tracker.feedforward(from.time, sample.feedforward);
  if (record.options.closed_loop) tracker.feedback(from.time, from.q, from.v, sample.feedback);
  sample.tau = from.tau;
  const TrackingPlan::Segment& segment = tracker.plan().segments[from.segment];
  for (std::size_t c = 0; c < robot.contacts().size(); ++c) {
    ContactReading& reading = sample.contacts.emplace_back();
    reading.touches = segment.in_contact[c];
    reading.force = from.force.segment<3>(3 * static_cast<Eigen::Index>(c));
  }
  return sample;
}

}  // namespace

std::vector<std::string> rollout_failures(const Tracker& tracker, const Rollout& rollout,
                                          const RolloutMeasures& measures, const SuccessCriteria& criteria) {
  if (!rollout.fell) return failures_in_rest(measures.base_position, measures.base_angle, criteria);
  return {fmt::format("fell at {:.3f} s, in phase '{}'", rollout.end_time, last_segment(tracker, rollout).name)};
}

std::string rollout_summary(const PlanRecord& plan, const RolloutRecord& record) {
  const RolloutMeasures& measures = record.measures;
  const RobotModel& robot = plan.task.problem.robot;
  std::string text = fmt::format("{} {}, rollout of the projected dynamics, {}: {}\n", robot.name(),
                                 plan.task.problem.name, record.options.closed_loop ? "closed loop" : "open loop",
                                 record.failures.empty() ? "success" : "FAILED");
  const double rate = control_rate(record.options);
  text += fmt::format("  {}; control {}, true state\n", offset_text(record),
                      rate > 0.0 ? fmt::format("at {:g} Hz", rate) : "continuous");
  for (const std::string& failure : record.failures) text += fmt::format("  failed: {}\n", failure);
  text += error_heading();
  text += error_line("base position", measures.base_position, 0.01, "cm ");
  text += error_line("base orientation", measures.base_angle, kDegree, "deg");
  text += error_line("worst joint", measures.joints, kDegree, "deg");
  text += torque_line(torque_use(measures));
  text +=
      "  contacts hold under any force here: on real ground a foot that pulls (< 0)\n"
      "  would lift, and one beyond its friction cone (> 0) would slip\n";
  text += fmt::format("  {:<28}{:>24}{:>24}\n", "contact", "least normal force", "beyond friction cone");
  for (std::size_t c = 0; c < measures.contacts.size(); ++c) {
    const ContactLoad& load = measures.contacts[c];
    if (!load.stood) continue;
    text += fmt::format("  {:<28}{:>24}{:>24}\n", robot.contacts()[c].name,
                        fmt::format("{:.1f} N at {:.3f} s", load.least_normal_force, load.least_normal_time),
                        fmt::format("{:.1f} N at {:.3f} s", load.beyond_cone, load.beyond_cone_time));
  }
  return text;
}

std::string rollout_json(const PlanRecord& plan, const Tracker& tracker, const RolloutRecord& record) {
  const RolloutMeasures& measures = record.measures;
  Json json = verdict_json(plan, {kRolloutEngine, record.failures, record.rollout.fell ? "fell" : "finished",
                                  record.rollout.end_time, last_segment(tracker, record.rollout).name});
  json.update({{"base_position_m", error_json(measures.base_position)},
               {"base_angle_rad", error_json(measures.base_angle)},
               {"joints_rad", error_json(measures.joints)},
               {"torque", torque_json(torque_use(measures))},
               {"contact_model", "contacts hold under any force: they can pull and do not slip"},
               {"contacts", Json::object()}});
  for (std::size_t c = 0; c < measures.contacts.size(); ++c) {
    json["contacts"][plan.task.problem.robot.contacts()[c].name] = load_json(measures.contacts[c]);
  }
  json["options"] = {{"open_loop", !record.options.closed_loop},
                     {"control_rate_Hz", control_rate(record.options)},
                     {"base_offset_m", vector_json(record.base_offset)},
                     {"base_offset_rad", vector_json(record.base_offset_rpy)},
                     {"friction", nullptr},
                     {"tolerance", record.options.tolerance}};
  if (record.friction) json["options"]["friction"] = *record.friction;
  return json_text(json);
}

std::string rollout_csv(const RobotModel& robot, const Tracker& tracker, const RolloutRecord& record) {
  std::vector<SimulationSample> samples;
  double next = tracker.start();
  for (const RolloutSample& sample : record.rollout.samples) {
    if (record.record_rate <= 0.0 || sample.time < next - 1e-9) continue;
    samples.push_back(as_simulation_sample(robot, tracker, record, sample));
    next += 1.0 / record.record_rate;
  }
  return simulation_csv(robot, samples);
}

void write_rollout(const std::filesystem::path& directory, const PlanRecord& plan, const Tracker& tracker,
                   const RolloutRecord& record) {
  write_simulation_files(directory, rollout_json(plan, tracker, record),
                         rollout_csv(plan.task.problem.robot, tracker, record));
}

}  // namespace prowl

#include "prowl/online/online_json.hpp"

#include <algorithm>

#include "prowl/files/json_text.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

Json ticks_json(const std::vector<double>& times) {
  const TickTimes ticks(times);
  return {{"median", ticks.median}, {"p99", ticks.p99}, {"longest", ticks.worst}};
}

const char* name_of(OnlineResult::End end) {
  switch (end) {
    case OnlineResult::End::finished: return "finished";
    case OnlineResult::End::fell: return "fell";
    case OnlineResult::End::diverged: return "diverged";
    case OnlineResult::End::stopped: return "stopped";
  }
  return "unknown";
}

Json forces_json(const ForceCount& count) { return {{"plans", count.plans}, {"outside", count.outside}}; }

}  // namespace

TickTimes::TickTimes(std::vector<double> times) {
  if (times.empty()) return;
  std::ranges::sort(times);
  const auto at = [&](double share) {
    return 1e3 * times[std::min(times.size() - 1, static_cast<std::size_t>(share * static_cast<double>(times.size())))];
  };
  median = at(0.5);
  p99 = at(0.99);
  worst = 1e3 * times.back();
}

std::string online_json(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result) {
  const Json last = result.last_velocity ? Json(*result.last_velocity) : Json();
  const Json json = {
      {"robot", robot.name()},
      {"gaits", gaits_of(options)},
      {"seed", options.simulation.seed},
      {"success", result.success()},
      {"end", name_of(result.end)},
      {"end_time_s", result.end_time},
      {"failures", result.failures},
      {"notes", result.notes},
      {"velocity_error_mps", result.velocity_error},
      {"turn_error_radps", result.turn_error},
      {"last_velocity_error_mps", last},
      {"largest_torque_share", result.largest_torque_share},
      {"control_steps", result.control_steps},
      {"steps_beyond_limits", result.steps_beyond_limits},
      {"plans", result.counters.updates},
      {"failed_plans", result.counters.failed},
      {"restarted_plans", result.counters.restarted},
      {"late_plans", result.late},
      {"dropped_plans", result.dropped},
      {"damped_steps", result.counters.damped},
      {"forces", {{"undisturbed", forces_json(result.undisturbed)}, {"kicked", forces_json(result.kicked)}}},
      {"plan_ms", ticks_json(result.times)},
      {"feedback_ms", ticks_json(result.feedbacks)},
      {"wall_ms", ticks_json(result.walls)}};
  return json_text(json);
}

}  // namespace prowl

#include "screen/online_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "prowl/files/json_text.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

/// Computing times of plans at shares of their order [ms].
struct TickTimes {
  double median = 0.0, p99 = 0.0, worst = 0.0;

  explicit TickTimes(std::vector<double> times) {
    if (times.empty()) return;
    std::ranges::sort(times);
    const auto at = [&](double share) {
      return 1e3 *
             times[std::min(times.size() - 1, static_cast<std::size_t>(share * static_cast<double>(times.size())))];
    };
    median = at(0.5);
    p99 = at(0.99);
    worst = 1e3 * times.back();
  }
};

}  // namespace

std::string online_summary(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result) {
  const TickTimes ticks(result.times);
  std::string text = fmt::format("{}, {}, {:.1f} s: {}\n", robot.name(), options.gait, result.end_time,
                                 result.success() ? "success" : "failure");
  for (const std::string& failure : result.failures) text += fmt::format("  {}\n", failure);
  text += fmt::format("velocity error {:.3f} m/s rms, turn rate {:.3f} rad/s rms\n", result.velocity_error,
                      result.turn_error);
  text += fmt::format("plans: {}, of these {} failed and {} were late and lost\n", result.counters.updates,
                      result.counters.failed, result.dropped);
  text += fmt::format("CPU time of a plan: median {:.1f} ms, 99 % below {:.1f} ms, longest {:.1f} ms; budget {:g} ms\n",
                      ticks.median, ticks.p99, ticks.worst, 1e3 * options.budget);
  return text;
}

std::string online_json(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result) {
  const TickTimes ticks(result.times);
  const Json json = {{"robot", robot.name()},
                     {"gait", options.gait},
                     {"seed", options.simulation.seed},
                     {"success", result.success()},
                     {"end", to_string(result.end)},
                     {"end_time_s", result.end_time},
                     {"failures", result.failures},
                     {"velocity_error_mps", result.velocity_error},
                     {"turn_error_radps", result.turn_error},
                     {"last_velocity_error_mps", result.last_velocity},
                     {"largest_torque_share", result.largest_torque_share},
                     {"plans", result.counters.updates},
                     {"failed_plans", result.counters.failed},
                     {"restarted_plans", result.counters.restarted},
                     {"dropped_plans", result.dropped},
                     {"damped_steps", result.counters.damped},
                     {"plan_ms", {{"median", ticks.median}, {"p99", ticks.p99}, {"longest", ticks.worst}}}};
  return json_text(json);
}

}  // namespace prowl

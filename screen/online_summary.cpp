#include "screen/online_summary.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "prowl/online/online_json.hpp"

namespace prowl {
namespace {

const char* verdict(const OnlineResult& result) {
  if (!result.success()) return "failure";
  return result.end == OnlineResult::End::stopped ? "success until it was stopped" : "success";
}

const char* late_plans_did(LatePlans late, long count) {
  if (count == 0) return "";
  switch (late) {
    case LatePlans::act: return ", but acted as if ready";
    case LatePlans::drop: return " and were lost";
    case LatePlans::wait: return " and acted later";
  }
  return "";
}

}  // namespace

std::string online_summary(const RobotModel& robot, const OnlineOptions& options, const OnlineResult& result) {
  const TickTimes ticks(result.times);
  std::string text = fmt::format("{}, {}, {:.1f} s: {}\n", robot.name(), fmt::join(gaits_of(options), ", "),
                                 result.end_time, verdict(result));
  for (const std::string& failure : result.failures) text += fmt::format("  {}\n", failure);
  text += fmt::format("velocity error {:.3f} m/s rms, turn rate {:.3f} rad/s rms\n", result.velocity_error,
                      result.turn_error);
  text += fmt::format("plans: {}, of these {} failed and {} took longer than the budget{}\n", result.counters.updates,
                      result.counters.failed, result.late, late_plans_did(options.late, result.late));
  text += fmt::format("forces outside their cones by more than 1 % of the weight: {} of {} plans undisturbed",
                      result.undisturbed.outside, result.undisturbed.plans);
  if (result.kicked.plans > 0)
    text += fmt::format(", {} of {} within 0.5 s of a push", result.kicked.outside, result.kicked.plans);
  text += "\n";
  for (const std::string& note : result.notes) text += fmt::format("note: {}\n", note);
  text += fmt::format("CPU time of a plan: median {:.1f} ms, 99 % below {:.1f} ms, longest {:.1f} ms; budget {:g} ms\n",
                      ticks.median, ticks.p99, ticks.worst, 1e3 * options.budget);
  return text;
}

}  // namespace prowl

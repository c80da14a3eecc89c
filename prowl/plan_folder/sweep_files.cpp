#include "prowl/plan_folder/sweep_files.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "prowl/files/json_text.hpp"
#include "prowl/plan_folder/simulation_parts.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

struct Count {
  std::string phase;
  int successes = 0, cases = 0;
};

/// Cases by the phase in which they were pushed, in the order of the phases.
std::vector<Count> by_phase(const Tracker& tracker, const SweepRecord& record) {
  std::vector<Count> counts;
  for (const TrackingPlan::Segment& segment : tracker.plan().segments) counts.push_back({segment.name});
  for (const SweepCase& one : record.cases) {
    if (one.options.pushes.empty()) continue;
    Count& count = *std::ranges::find(counts, pushed_phase(tracker, one.options), &Count::phase);
    ++count.cases;
    count.successes += one.result.success() ? 1 : 0;
  }
  std::erase_if(counts, [](const Count& count) { return count.cases == 0; });
  return counts;
}

SuccessRate overall(const SweepRecord& record) {
  const auto successes = std::ranges::count_if(record.cases, [](const SweepCase& one) { return one.result.success(); });
  return success_rate(static_cast<int>(successes), static_cast<int>(record.cases.size()));
}

/// Failures first, the earliest end first; then by the distance of the base at rest from the plan's end.
std::vector<std::size_t> worst_first(const SweepRecord& record) {
  std::vector<std::size_t> order(record.cases.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::ranges::stable_sort(order, {}, [&](std::size_t i) {
    const SimulationResult& result = record.cases[i].result;
    return std::tuple(result.success(), result.end == SimulationResult::End::finished, result.end_time,
                      result.end == SimulationResult::End::finished ? -result.base_position.rest : 0.0);
  });
  return order;
}

Json size_json(std::optional<double> size) { return size ? Json(*size) : Json(nullptr); }

}  // namespace

std::string sweep_summary(const PlanRecord& plan, const Tracker& tracker, const SweepRecord& record) {
  const SuccessRate rate = overall(record);
  std::string text =
      fmt::format("{} {} in MuJoCo, perturbed: {} of {} succeed, {:.1f} % (95 % interval: {:.1f} to {:.1f} %)\n",
                  plan.task.problem.robot.name(), plan.task.problem.name, rate.successes, rate.cases, 100 * rate.rate(),
                  100 * rate.lower, 100 * rate.upper);
  if (record.interrupted) {
    text += rate.cases < record.asked
                ? fmt::format("  interrupted: {} of {} simulations were finished\n", rate.cases, record.asked)
                : "  interrupted during the simulations of one perturbation alone\n";
  }
  const std::vector<Count> pushed = by_phase(tracker, record);
  if (!pushed.empty()) text += "  pushed in phase                             success\n";
  for (const Count& count : pushed) {
    text += fmt::format("    {:<40}  {} of {}\n", count.phase, count.successes, count.cases);
  }
  const bool is_replayed = record.ranges == only(record.only) && !record.cases.front().options.open_loop;
  const std::string kinds = record.only.empty() ? "" : fmt::format(" --only {}", fmt::join(record.only, ","));
  text += is_replayed ? fmt::format("  cases, worst first (prowl simulate DIR --case SEED{})\n", kinds)
                      : "  cases, worst first\n";
  const std::vector<std::size_t> order = worst_first(record);
  constexpr std::size_t kWorst = 5;
  for (std::size_t i = 0; i < std::min(kWorst, order.size()); ++i) {
    const SweepCase& one = record.cases[order[i]];
    text += fmt::format(
        "    seed {:<6} {}: {}\n", record.first_seed + order[i], world_in_words(plan.task.problem.robot, one.options),
        one.result.success() ? fmt::format("success, base {:.1f} cm off", 100 * one.result.base_position.rest)
                             : one.result.failures.front());
  }
  if (!record.breakdowns.empty()) text += "  one perturbation alone: success falls below one half between\n";
  for (const Breakdown& found : record.breakdowns) {
    text +=
        fmt::format("    {:<20} {}\n", found.kind,
                    std::isfinite(found.fails) ? fmt::format("{:g} and {:g} {}", found.holds, found.fails, found.unit)
                                               : fmt::format("not up to {:g} {}", found.holds, found.unit));
  }
  return text;
}

std::string sweep_json(const PlanRecord& plan, const Tracker& tracker, const SweepRecord& record) {
  const SuccessRate rate = overall(record);
  const PerturbationRanges& ranges = record.ranges;
  Json json = {{"schema_version", 2},
               {"name", plan.task.problem.name},
               {"robot", plan.task.problem.robot.name()},
               {"interrupted", record.interrupted},
               {"first_seed", record.first_seed},
               {"cases_asked", record.asked},
               {"cases", rate.cases},
               {"successes", rate.successes},
               {"success_rate", rate.rate()},
               {"interval_95", {rate.lower, rate.upper}},
               {"only", record.only},
               {"ranges",
                {{"base_position_m", ranges.base_position},
                 {"base_angle_rad", ranges.base_angle},
                 {"base_velocity_mps", ranges.base_velocity},
                 {"base_rate_radps", ranges.base_rate},
                 {"joint_rad", ranges.joint},
                 {"mass", ranges.mass},
                 {"base_center_m", ranges.base_center},
                 {"friction", {ranges.friction_low, ranges.friction_high}},
                 {"bandwidth_Hz", {ranges.bandwidth_low, ranges.bandwidth_high}},
                 {"delay_s", {ranges.delay_low, ranges.delay_high}},
                 {"ground_height_m", ranges.ground_height},
                 {"ground_tilt_rad", ranges.ground_tilt},
                 {"noise", {ranges.noise_low, ranges.noise_high}},
                 {"push_velocity_mps", ranges.push_velocity},
                 {"push_Ns", size_json(ranges.push)},
                 {"push_on_two_feet_Ns", size_json(ranges.push_on_two_feet)},
                 {"push_duration_s", ranges.push_duration}}},
               {"phases", Json::array()},
               {"worst", Json::array()},
               {"breakdowns", Json::array()},
               {"versions", {{"MuJoCo", Physics::version()}}}};
  for (const Count& count : by_phase(tracker, record)) {
    json["phases"].push_back({{"phase", count.phase}, {"successes", count.successes}, {"cases", count.cases}});
  }
  for (const std::size_t i : worst_first(record)) {
    const SweepCase& one = record.cases[i];
    json["worst"].push_back({{"seed", record.first_seed + i},
                             {"success", one.result.success()},
                             {"failures", one.result.failures},
                             {"perturbation", world_in_words(plan.task.problem.robot, one.options)},
                             {"pushed_in_phase", pushed_phase(tracker, one.options)},
                             {"rest_position_m", one.result.base_position.rest},
                             {"rest_angle_rad", one.result.base_angle.rest},
                             {"largest_slip_m", *std::ranges::max_element(one.result.slip)}});
  }
  for (const Breakdown& found : record.breakdowns) {
    Json entry = {{"kind", found.kind}, {"unit", found.unit}, {"holds", found.holds}, {"fails", nullptr}};
    if (std::isfinite(found.fails)) entry["fails"] = found.fails;
    json["breakdowns"].push_back(entry);
  }
  return json_text(json);
}

}  // namespace prowl

#include "screen/benchmark_table.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/files/json_text.hpp"
#include "prowl/simulation/sweep.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

/// Of all runs of a row.
struct RowSums {
  int runs = 0, successes = 0, falls = 0;
  double turn = 0.0, p99 = 0.0, longest = 0.0, feedback = 0.0;
  std::vector<double> medians, velocities;
  long plans = 0, outside = 0, kicked_plans = 0, kicked_outside = 0, steps = 0, beyond = 0, dropped = 0;

  void add(const Json& run) {
    ++runs;
    if (run["success"]) ++successes;
    if (run["end"] != "finished") ++falls;
    velocities.push_back(run["velocity_error_mps"]);
    turn = std::max<double>(turn, run["turn_error_radps"]);
    const Json& ticks = run["plan_ms"];
    medians.push_back(ticks["median"]);
    p99 = std::max<double>(p99, ticks["p99"]);
    longest = std::max<double>(longest, ticks["longest"]);
    feedback = std::max<double>(feedback, run["feedback_ms"]["p99"]);
    const Json &undisturbed = run["forces"]["undisturbed"], &kicked = run["forces"]["kicked"];
    plans += undisturbed["plans"].get<long>();
    outside += undisturbed["outside"].get<long>();
    kicked_plans += kicked["plans"].get<long>();
    kicked_outside += kicked["outside"].get<long>();
    steps += run["control_steps"].get<long>();
    beyond += run["steps_beyond_limits"].get<long>();
    dropped += run["dropped_plans"].get<long>();
  }
};

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

std::string percent(long part, long all) {
  return all > 0 ? fmt::format("{:.2f} %", 100.0 * static_cast<double>(part) / static_cast<double>(all)) : "";
}

std::string table_row(const BenchmarkRow& row, const RowSums& sums) {
  const SuccessRate rate = success_rate(sums.successes, sums.runs);
  return fmt::format(
      "| {} | {} | {} of {} | {:.0f} to {:.0f} % | {} | {} | {:.3f} | {:.3f} | {:.3f} | {:.1f} | {:.1f} | {:.1f} | "
      "{:.1f} | {} | {} | {} | {} |\n",
      row.name, row.meaning, sums.successes, sums.runs, 100.0 * rate.lower, 100.0 * rate.upper, sums.falls,
      row.pendulum > 0.0 ? fmt::format("{:.2f}", row.pendulum) : "", median(sums.velocities),
      *std::ranges::max_element(sums.velocities), sums.turn, median(sums.medians), sums.p99, sums.longest,
      sums.feedback, percent(sums.outside, sums.plans), percent(sums.kicked_outside, sums.kicked_plans),
      percent(sums.beyond, sums.steps), sums.dropped);
}

}  // namespace

std::string benchmark_table(const RobotModel& robot, const std::vector<BenchmarkRow>& rows, const std::string& runs) {
  const Json all = Json::parse(runs);
  std::string text = fmt::format(
      "{}. Errors from the smoothed command: RMS of velocity [m/s] and of turn rate [rad/s]. CPU times of plans [ms]: "
      "p50 and p99 of a run; median and worst of the runs. Outside: plans with forces outside their cones by more than "
      "1 % of the weight. Beyond: control steps whose commanded torques are more than 1 % beyond a limit at the true "
      "state.\n\n"
      "| row | meaning | success | 95 % interval | falls | pendulum [m/s] | velocity error, median | worst | turn "
      "error, worst | p50, median | p99, worst | longest | p99 of feedback | outside | within 0.5 s of a kick | beyond "
      "| dropped |\n"
      "|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|---|\n",
      robot.name());
  for (const BenchmarkRow& row : rows) {
    RowSums sums;
    for (const Json& run : all) {
      if (run["row"] == row.name) sums.add(run);
    }
    if (sums.runs > 0) text += table_row(row, sums);
  }
  return text;
}

}  // namespace prowl

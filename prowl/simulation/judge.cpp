#include "prowl/simulation/judge.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace prowl {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

using Texts = std::vector<std::string>;

void judge_switches(const SimulationResult& result, const MotionProblem& problem, const SuccessCriteria& criteria,
                    Texts& texts) {
  const double most_off = allowed_distance(problem.robot, criteria);
  for (const ContactSwitch& change : result.switches) {
    const std::string what = fmt::format("{} {}, planned at {:.3f} s", problem.robot.contacts()[change.contact].name,
                                         change.lands ? "landing" : "lift-off", change.planned);
    const double late = change.measured - change.planned, most_late = allowed_delay(change, criteria);
    if (std::isnan(change.measured)) {
      texts.push_back(what + ": did not happen");
      continue;
    }
    if (!(std::abs(late) <= most_late))
      texts.push_back(fmt::format("{}: {:.0f} ms {}; {:.0f} ms allowed", what, 1e3 * std::abs(late),
                                  late > 0.0 ? "late" : "early", 1e3 * most_late));
    if (!change.lands) continue;
    if (!change.on_its_surface) texts.push_back(what + ": on another surface");
    if (!(change.off <= most_off))
      texts.push_back(
          fmt::format("{}: {:.1f} cm from its foothold; {:.1f} cm allowed", what, 100 * change.off, 100 * most_off));
  }
}

void judge_goals(const SimulationResult& result, const MotionProblem& problem, const SuccessCriteria& criteria,
                 Texts& texts) {
  for (const GoalError& goal : result.goals) {
    if (!(goal.position <= criteria.position))
      texts.push_back(fmt::format("{}: base {:.1f} cm off; {:.1f} cm allowed", goal.name, 100 * goal.position,
                                  100 * criteria.position));
    if (!(goal.angle <= criteria.angle))
      texts.push_back(fmt::format("{}: base turned {:.1f} degrees off; {:.1f} allowed", goal.name,
                                  kDegrees * goal.angle, kDegrees * criteria.angle));
    if (!(goal.joint <= criteria.angle))
      texts.push_back(fmt::format("{}: {} {:.1f} degrees off; {:.1f} allowed", goal.name, goal.worst_joint,
                                  kDegrees * goal.joint, kDegrees * criteria.angle));
  }
  const double most_off = allowed_distance(problem.robot, criteria);
  for (const FlightHeight& flight : result.flights) {
    if (!(flight.missing <= most_off))
      texts.push_back(fmt::format("base {:.1f} cm too low in the middle of phase '{}'; {:.1f} cm allowed",
                                  100 * flight.missing, flight.phase, 100 * most_off));
  }
}

}  // namespace

double allowed_distance(const RobotModel& robot, const SuccessCriteria& criteria) {
  return std::min(criteria.distance, criteria.distance_share * robot.nominal_configuration().z());
}

double allowed_delay(const ContactSwitch& change, const SuccessCriteria& criteria) {
  return std::min(criteria.delay, criteria.delay_share * change.swing);
}

Texts failures(const SimulationResult& result, const MotionProblem& problem, const SuccessCriteria& criteria) {
  if (result.end == SimulationResult::End::fell)
    return {fmt::format("fell at {:.3f} s, in phase '{}'", result.end_time, result.phase)};
  if (result.end == SimulationResult::End::diverged)
    return {fmt::format("the simulation diverged at {:.3f} s", result.end_time)};
  Texts texts = failures_in_rest(result.base_position, result.base_angle, criteria);
  judge_switches(result, problem, criteria, texts);
  judge_goals(result, problem, criteria, texts);
  const double most_off = allowed_distance(problem.robot, criteria);
  for (std::size_t c = 0; c < result.slip.size(); ++c) {
    if (result.slip[c] <= most_off) continue;
    texts.push_back(fmt::format("{} slipped {:.1f} cm; {:.1f} cm allowed", problem.robot.contacts()[c].name,
                                100 * result.slip[c], 100 * most_off));
  }
  for (const std::string& touch : result.touches) texts.push_back("touched: " + touch);
  if (!(result.saturated <= criteria.at_limit))
    texts.push_back(fmt::format("a torque is at its limit for {:.1f} % of the time; {:.1f} % allowed",
                                100 * result.saturated, 100 * criteria.at_limit));
  return texts;
}

Texts failures_in_rest(const ErrorMeasure& base_position, const ErrorMeasure& base_angle,
                       const SuccessCriteria& criteria) {
  Texts texts;
  if (!(base_position.rest <= criteria.position)) {
    texts.push_back(fmt::format("base {:.1f} cm from where the plan ends; {:.1f} cm allowed", 100 * base_position.rest,
                                100 * criteria.position));
  }
  if (!(base_angle.rest <= criteria.angle)) {
    texts.push_back(fmt::format("base turned {:.1f} degrees from where the plan ends; {:.1f} allowed",
                                kDegrees * base_angle.rest, kDegrees * criteria.angle));
  }
  return texts;
}

}  // namespace prowl

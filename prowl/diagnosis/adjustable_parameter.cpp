#include "prowl/diagnosis/adjustable_parameter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "prowl/diagnosis/asked_parameters.hpp"
#include "prowl/diagnosis/joint_parameters.hpp"
#include "prowl/motion/duration_limits.hpp"

namespace prowl {

namespace {

constexpr double kMostFriction = 0.8;  // rubber on dry concrete; robots that rely on more fall

AdjustableParameter friction_parameter(const MotionProblem& problem, int surface) {
  const Surface& one = problem.surfaces[surface];
  return {.kind = "friction",
          .subject = one.name,
          .most = std::log(kMostFriction / one.friction),
          .unit = "",
          .value = [&one](double a) { return one.friction * std::exp(a); },
          .problem =
              [&problem, surface](double a) {
                MotionProblem changed = problem;
                changed.surfaces[surface].friction *= std::exp(a);
                return changed;
              }};
}

double seconds_of(const MotionProblem& problem, int phase, double sign) {
  double time = 0.0;
  for (int p = 0; p < static_cast<int>(problem.phases.size()); ++p) {
    const Duration& duration = problem.phases[p].duration;
    if (phase < 0 || p == phase) time += sign > 0.0 ? duration.max : duration.min;
  }
  return time;
}

/// Largest amount for a duration, within the limits of task files.
double most_of_duration(const MotionProblem& problem, int phase, double sign) {
  const double seconds = seconds_of(problem, phase, sign);
  if (sign < 0.0) return std::clamp(std::log(seconds / kShortestPhase), 0.0, kMostAmount);
  constexpr double kUsual = 3.0;  // [s], for a phase given in milliseconds by mistake
  const double longest = kLongestMotion - (seconds_of(problem, -1, sign) - seconds);
  return std::min(std::max(kMostAmount, std::log(kUsual / seconds)), std::log(std::max(longest / seconds, 1.0)));
}

/// phase -1: all phases together; sign -1: shorter.
AdjustableParameter duration_parameter(const MotionProblem& problem, int phase, double sign) {
  const auto scaled = [phase, sign](MotionProblem changed, double a) {
    for (int p = 0; p < static_cast<int>(changed.phases.size()); ++p) {
      if (phase >= 0 && p != phase) continue;
      Duration& duration = changed.phases[p].duration;
      const bool fixed = duration.is_fixed();
      (sign > 0.0 ? duration.max : duration.min) *= std::exp(sign * a);
      // A shorter flight keeps its old duration as the maximum: the optimiser chooses in between.
      if (fixed && sign > 0.0) duration.min = duration.max;
    }
    return changed;
  };
  return {.kind = "duration", .phase = phase,
          .subject = phase < 0 ? "" : problem.phases[phase].name,
          .most = most_of_duration(problem, phase, sign),
          .is_asked = true, .weight = phase < 0 ? kWeightOfAllTimes : kWeightOfTime, .unit = "s",
          .value = [&problem, phase, sign](double a) { return seconds_of(problem, phase, sign) * std::exp(sign * a); },
          .problem = [&problem, scaled](double a) { return scaled(problem, a); },
          .words = sign > 0.0 ? std::function<std::string(double)>() : [&problem, scaled, phase](double a) {
            const Duration duration = scaled(problem, a).phases[phase].duration;
            return duration.is_fixed() ? fmt::format("{:.3g} s", duration.min) : fmt::format("[{:.3g}, {:.3g}] s", duration.min, duration.max);
          }};
}

/// Most phases with a parameter each for their duration; a gait has many phases, from one number.
constexpr int kMostPhases = 5;

constexpr std::size_t kStands = 3;  // contacts; with fewer, a robot cannot stand for long

}  // namespace

double printable_amount(const AdjustableParameter& parameter, double amount) {
  constexpr double kRounding = 1e-9;
  const double from = std::abs(parameter.value(0.0)), to = std::abs(parameter.value(amount));
  if (from == 0.0) return amount;  // no factor changes zero
  const double digit = std::pow(10.0, std::floor(std::log10(to)) - 2.0);
  const double rounded = digit * (to > from ? std::ceil(to / digit - kRounding) : std::floor(to / digit + kRounding));
  const double more = std::min(std::abs(std::log(rounded / from)), parameter.most);
  return more >= amount - kRounding ? more : amount;  // a range at its widest
}

std::vector<AdjustableParameter> adjustable_parameters(const MotionProblem& problem) {
  std::vector<AdjustableParameter> parameters;
  std::set<int> surfaces;
  for (const Phase& phase : problem.phases) {
    for (const PhaseContact& contact : phase.contacts) surfaces.insert(contact.surface);
  }
  for (const int surface : surfaces) {
    if (problem.surfaces[surface].friction < kMostFriction) parameters.push_back(friction_parameter(problem, surface));
  }
  for (const AdjustableParameter& parameter : asked_parameters(problem)) parameters.push_back(parameter);
  for (const AdjustableParameter& parameter : joint_parameters(problem)) parameters.push_back(parameter);
  const int phases = static_cast<int>(problem.phases.size());
  for (int p = 0; p < phases && phases <= kMostPhases; ++p) {
    parameters.push_back(duration_parameter(problem, p, 1.0));
    const bool may_be_shorter = problem.phases[p].contacts.size() < kStands;
    if (may_be_shorter) parameters.push_back(duration_parameter(problem, p, -1.0));
  }
  if (phases > 1) parameters.push_back(duration_parameter(problem, -1, 1.0));
  return parameters;
}

std::string in_words(const AdjustableParameter& parameter, double amount) {
  const std::string value =
      parameter.words ? parameter.words(amount)
                      : fmt::format("{}{:.3g}{}", parameter.is_factor ? "x " : "", parameter.value(amount),
                                    parameter.unit.empty() || parameter.is_factor ? "" : " " + parameter.unit);
  if (parameter.kind == "goal") return parameter.subject + " " + value;
  if (parameter.kind == "clearance") return "swing clearance " + value;
  const std::string subject = parameter.subject.empty() ? (parameter.kind == "duration" ? "all phases" : "all joints")
                              : parameter.kind != "duration" || parameter.phase < 0
                                  ? parameter.subject
                                  : "phase '" + parameter.subject + "'";
  const std::string what = parameter.kind == "torque"           ? "torque limits"
                           : parameter.kind == "joint_velocity" ? "velocity limits"
                           : parameter.kind == "joint_position" ? "position ranges"
                           : parameter.kind == "place"          ? "foothold"
                                                                : parameter.kind;
  return fmt::format("{} of {} {}", what, subject, value);
}

}  // namespace prowl

#include "prowl/motion/term_use.hpp"

#include <algorithm>
#include <cmath>

#include "prowl/motion/motion_problem.hpp"

namespace prowl {

namespace {

constexpr double kSameMoment = 1e-9;  // of a phase

}  // namespace

bool TermUse::is_moment() const { return std::abs(to.phase - from.phase + to.fraction - from.fraction) <= kSameMoment; }

bool TermUse::holds_at(int phase, double fraction) const {
  const bool is_over = phase > to.phase || (phase == to.phase && fraction > to.fraction + kSameMoment);
  return !is_over && (phase > from.phase || (phase == from.phase && fraction >= from.fraction - kSameMoment));
}

bool reads_rates(const Term& term) {
  return std::ranges::any_of(term.reads(), [](const Quantity& quantity) { return is_rate(quantity.kind); });
}

double natural_size(const RobotModel& robot, const std::string& unit) {
  const double rate = std::sqrt(RobotModel::kGravity / robot.size());
  if (unit == "m") return robot.size();
  if (unit == "m/s") return robot.size() * rate;
  return unit == "rad/s" ? rate : 1.0;
}

double term_tolerance(const GoalTolerance& tolerance, const std::string& unit) {
  constexpr double kOther = 1e-3;
  if (unit == "m") return tolerance.position;
  if (unit == "rad") return tolerance.angle;
  return unit == "m/s" || unit == "rad/s" ? tolerance.velocity : kOther;
}

}  // namespace prowl

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
  const bool has_end_alone =
      (phase == from.phase && from.fraction >= 1.0 - kSameMoment) || (phase == to.phase && to.fraction <= kSameMoment);
  if (has_end_alone && !is_moment()) return false;  // what differs at a phase transition is of the phase inside
  const bool is_over = phase > to.phase || (phase == to.phase && fraction > to.fraction + kSameMoment);
  return !is_over && (phase > from.phase || (phase == from.phase && fraction >= from.fraction - kSameMoment));
}

bool reads_rates(const Term& term) {
  return std::ranges::any_of(term.reads(), [](const Quantity& quantity) { return is_rate(quantity.kind); });
}

bool reads_loads(const Term& term) {
  return std::ranges::any_of(term.reads(), [](const Quantity& quantity) { return is_load(quantity.kind); });
}

double natural_size(const RobotModel& robot, const Term& term) {
  if (term.size() > 0.0) return term.size();
  const std::string& unit = term.unit();
  const double rate = std::sqrt(RobotModel::kGravity / robot.size());
  if (unit == "m") return robot.size();
  if (unit == "m/s") return robot.size() * rate;
  if (unit == "N") return robot.weight();
  if (unit == "N m") return robot.weight() * robot.size();
  if (unit == "N m s") return robot.mass() * robot.size() * robot.size() * rate;
  return unit == "rad/s" ? rate : 1.0;
}

double term_tolerance(const MotionProblem& problem, const Term& term) {
  constexpr double kForce = 1e-2;  // of the weight, as for friction: between nodes forces are not linear
  constexpr double kOther = 1e-3;
  const GoalTolerance& tolerance = problem.goal_tolerance;
  const std::string& unit = term.unit();
  if (term.size() == 0.0) {
    if (unit == "m") return tolerance.position;
    if (unit == "rad") return tolerance.angle;
    if (unit == "m/s" || unit == "rad/s") return tolerance.velocity;
    if (unit == "N") return kForce * problem.robot.weight();
  }
  return kOther * natural_size(problem.robot, term);
}

}  // namespace prowl

#include "prowl/elastic/breach.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace prowl {

namespace {

/// "joint velocity".
std::string name_of(LimitKind kind) {
  if (kind == LimitKind::foothold) return "landing place";
  std::string name = to_string(kind);
  std::ranges::replace(name, '_', ' ');
  return name;
}

}  // namespace

std::string phase_in_words(const MotionProblem& problem, int phase) {
  const std::string& name = problem.phases[phase].name;
  const std::string number = fmt::format("phase {}", phase + 1);
  return name == number ? number : fmt::format("{} '{}'", number, name);
}

std::string in_words(const Breach& breach, const MotionProblem& problem) {
  const bool says_its_kind = breach.kind == LimitKind::goal || breach.kind == LimitKind::term;
  const bool falls_short = breach.kind == LimitKind::friction || breach.kind == LimitKind::clearance;
  return fmt::format("{}, {}{} at {:.3g} s: {:.3g}{}{} {}", phase_in_words(problem, breach.phase), breach.subject,
                     says_its_kind ? "" : ", " + name_of(breach.kind), breach.time, breach.amount,
                     breach.unit.empty() ? "" : " ", breach.unit, falls_short ? "short" : "beyond its bound");
}

}  // namespace prowl

#include "prowl/motion/check_terms.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "prowl/error.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/motion/term_evaluation.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

template <class... Args>
[[noreturn]] void refuse_term(const std::string& field, fmt::format_string<Args...> format, Args&&... args) {
  throw InputError(field + ": " + fmt::format(format, std::forward<Args>(args)...));
}

void check_frames(const MotionProblem& problem, const std::string& field, const Term& term) {
  for (const Quantity& quantity : term.reads()) {
    if (!is_of_frame(quantity.kind)) continue;
    try {
      robot_frame(problem.robot, quantity.frame);
    } catch (const InputError& error) {
      refuse_term(field + ".frame", "{}", error.what());
    }
  }
}

void check_moment(const MotionProblem& problem, const std::string& field, PhaseFraction moment) {
  if (moment.phase < 0 || moment.phase >= static_cast<int>(problem.phases.size())) {
    refuse_term(field, "phase {} is not allowed; need 0 to {}", moment.phase, problem.phases.size() - 1);
  }
  if (!(moment.fraction >= 0.0 && moment.fraction <= 1.0)) {
    refuse_term(field, "fraction {} is not allowed; need 0 to 1", moment.fraction);
  }
}

void check_term_span(const MotionProblem& problem, const std::string& field, const TermUse& use) {
  check_moment(problem, field + ".from", use.from);
  check_moment(problem, field + ".to", use.to);
  if (!use.holds_at(use.to.phase, use.to.fraction)) refuse_term(field + ".to", "is before from; need a later moment");
  if (use.is_moment() && use.from.phase != use.to.phase) {
    refuse_term(field + ".to", "is the same time as from in another phase; need one phase for one moment");
  }
  const bool is_whole = use.from == PhaseFraction::start_of(0) &&
                        use.to == PhaseFraction::end_of(static_cast<int>(problem.phases.size()) - 1);
  if (problem.cycle && !is_whole) {
    refuse_term(field + ".from", "a part of a motion that repeats itself is not allowed; need all of it");
  }
}

void check_entries(const std::string& field, const VectorXd& values, int size) {
  if (values.size() != size) refuse_term(field, "{} entries are not allowed; need {}", values.size(), size);
}

void check_limit(const std::string& field, const TermUse& use) {
  const int rows = use.term->num_rows();
  check_entries(field + ".reference", use.reference, 0);  // a limit has none
  check_entries(field + ".lower", use.lower, rows);
  check_entries(field + ".upper", use.upper, rows);
  bool binds = false;
  for (int row = 0; row < rows; ++row) {
    const double lower = use.lower(row), upper = use.upper(row);
    if (!(lower <= upper) || (std::isinf(lower) && lower == upper)) {
      refuse_term(field + ".lower", "{} to {} for {} is not allowed; need lower <= upper", lower, upper,
                  use.term->rows()[row]);
    }
    binds = binds || std::isfinite(lower) || std::isfinite(upper);
  }
  if (!binds) refuse_term(field, "limits nothing; need one finite bound or more");
}

void check_term_cost(const std::string& field, const TermUse& use) {
  const int rows = use.term->num_rows();
  check_entries(field + ".lower", use.lower, 0);  // a cost has no bounds
  check_entries(field + ".upper", use.upper, 0);
  check_entries(field + ".weight", use.weight, rows);
  check_entries(field + ".reference", use.reference, rows);
  for (int row = 0; row < rows; ++row) {
    if (!std::isfinite(use.weight(row)) || use.weight(row) < 0.0) {
      refuse_term(field + ".weight", "{} is not allowed; need a finite number >= 0", use.weight(row));
    }
    if (!std::isfinite(use.reference(row))) {
      refuse_term(field + ".reference", "{} is not allowed; need a finite number", use.reference(row));
    }
  }
}

/// No later motion can change a fixed start.
void check_term_at_start(const MotionProblem& problem, const std::string& field, const TermUse& use,
                         const RigidBodyTerms& kinematics) {
  const BoundaryConstraint& start = problem.start();
  const bool is_known = start.fixes_configuration() && (start.fixes_velocity() || !reads_rates(*use.term));
  if (!is_known || !use.holds_at(0, 0.0)) return;
  TermEvaluation term(problem.robot, use);
  try {
    term.evaluate(kinematics, start.q_ref, start.velocity_lower);
  } catch (const NumericalError& error) {
    refuse_term(field, "at the start: {}; need another start or reference", error.what());
  }
  if (use.is_cost()) return;
  for (int row = 0; row < use.term->num_rows(); ++row) {
    const double value = term.value()(row);
    const double outside = std::max(use.lower(row) - value, value - use.upper(row));
    if (outside <= term_tolerance(problem.goal_tolerance, use.term->unit())) continue;
    refuse_term(field, "at the start {} is {:.4g} {}, {:.4g} beyond its bound; need another start, or a later moment",
                use.term->rows()[row], value, use.term->unit(), outside);
  }
}

/// Every cycle must keep the limits and have the cost of the first.
void check_term_in_cycles(const MotionProblem& problem, const std::string& field, const TermUse& use) {
  constexpr double kSame = 1e-9;
  if (!problem.cycle || problem.cycle->count == 1) return;
  TermEvaluation term(problem.robot, use);
  RigidBodyTerms kinematics(problem.robot);
  const VectorXd& q = problem.start_configuration();
  const auto value = [&](const VectorXd& at) -> VectorXd {
    kinematics.update_kinematics(at);
    term.evaluate(kinematics, at, VectorXd::Ones(problem.robot.nv()));
    return term.value();
  };
  const VectorXd change = value(problem.cycle->moved_configuration(q)) - value(q);
  for (int row = 0; row < use.term->num_rows(); ++row) {
    const bool counts =
        use.is_cost() ? use.weight(row) > 0.0 : std::isfinite(use.lower(row)) || std::isfinite(use.upper(row));
    if (!counts || std::abs(change(row)) <= kSame) continue;
    refuse_term(field, "{} changes by {:.4g} {} from cycle to cycle; need a quantity that repeats itself",
                use.term->rows()[row], change(row), use.term->unit());
  }
}

}  // namespace

void check_terms(const MotionProblem& problem) {
  if (problem.terms.empty()) return;
  RigidBodyTerms kinematics(problem.robot);
  kinematics.update_kinematics(problem.start_configuration());
  for (std::size_t i = 0; i < problem.terms.size(); ++i) {
    const TermUse& use = problem.terms[i];
    const std::string field = fmt::format("terms[{}]", i);
    if (!use.term) refuse_term(field + ".term", "none is not allowed; need a term");
    if (use.name.empty()) refuse_term(field + ".name", "an empty name is not allowed");
    for (std::size_t other = 0; other < i; ++other) {
      if (problem.terms[other].name == use.name) refuse_term(field + ".name", "'{}' is already another term", use.name);
    }
    check_frames(problem, field, *use.term);
    check_term_span(problem, field, use);
    use.is_cost() ? check_term_cost(field, use) : check_limit(field, use);
    check_term_at_start(problem, field, use, kinematics);
    check_term_in_cycles(problem, field, use);
  }
}

}  // namespace prowl

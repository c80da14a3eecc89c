#include "prowl/motion/check_terms.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "prowl/error.hpp"
#include "prowl/model/all_contacts.hpp"
#include "prowl/model/configuration.hpp"
#include "prowl/model/robot_frame.hpp"
#include "prowl/motion/contradicting_terms.hpp"
#include "prowl/motion/term_evaluation.hpp"
#include "prowl/terms/term_derivatives.hpp"

namespace prowl {

namespace {

using Eigen::VectorXd;

template <class... Args>
[[noreturn]] void refuse_term(const std::string& field, fmt::format_string<Args...> format, Args&&... args) {
  throw InputError(field + ": " + fmt::format(format, std::forward<Args>(args)...));
}

void check_names(const MotionProblem& problem, const std::string& field, const Term& term) {
  if (term.reads().empty()) refuse_term(field + ".term", "reads nothing; need one quantity or more");
  if (term.num_rows() == 0) refuse_term(field + ".term", "has no rows; need one or more");
  if (!(term.size() >= 0.0 && std::isfinite(term.size()))) {
    refuse_term(field + ".term", "a size of {} is not allowed; need a finite number, or 0 for that of the unit",
                term.size());
  }
  for (const Quantity& quantity : term.reads()) {
    try {
      if (is_of_frame(quantity.kind)) robot_frame(problem.robot, quantity.name);
      if (quantity.kind == Quantity::Kind::force) problem.robot.contact_index(quantity.name);
    } catch (const InputError& error) {
      refuse_term(field + (is_of_frame(quantity.kind) ? ".frame" : ".contact"), "{}", error.what());
    }
  }
}

/// Numbers of all sizes up to the largest, without the symmetries at which wrong derivatives may be right.
VectorXd mixed(Eigen::Index size, double largest) {
  return largest * VectorXd::LinSpaced(size, 1.0, static_cast<double>(size)).array().sin();
}

/// At the first of some moving states near the start at which the term is defined; also with contacts that all push.
void check_derivatives(const MotionProblem& problem, const std::string& field, const TermUse& use) {
  constexpr double kTime = std::numbers::pi / 3.0;  // [s] not where a reference has a sample, and so a kink
  const RobotModel& robot = problem.robot;
  const std::vector<int> contacts = all_contacts(robot);
  RigidBodyTerms kinematics(robot);
  TermEvaluation term(robot, use, contacts);
  for (const double share : {1.0, -1.0, 0.1, -0.1}) {
    for (const bool pushes : {false, true}) {
      const VectorXd q = integrate(problem.start_configuration(), mixed(robot.nv(), 0.2 * share));
      const VectorXd v = mixed(robot.nv(), share), tau = mixed(robot.nu(), share * robot.weight() * robot.size());
      VectorXd forces = mixed(3 * std::ssize(contacts), share * robot.weight());
      if (pushes) forces = forces.cwiseAbs();
      kinematics.update_kinematics(q);
      std::string wrong;
      try {
        term.evaluate({kinematics, q, v, tau, forces, kTime});
        wrong = wrong_derivative(robot, *use.term, term.reading());
      } catch (const NumericalError&) {
        continue;  // not defined there
      } catch (const InputError& error) {
        wrong = error.what();
      }
      if (!wrong.empty()) refuse_term(field + ".term", "{}", wrong);
      return;
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
  const bool is_before = use.to.phase < use.from.phase ||
                         (use.to.phase == use.from.phase && !use.is_moment() && use.to.fraction < use.from.fraction);
  if (is_before) refuse_term(field + ".to", "is before from; need a later moment");
  if (use.is_moment() && use.from.phase != use.to.phase) {
    refuse_term(field + ".to", "is the same time as from in another phase; need one phase for one moment");
  }
  const bool is_whole = use.from == PhaseFraction::start_of(0) &&
                        use.to == PhaseFraction::end_of(static_cast<int>(problem.phases.size()) - 1);
  if (problem.cycle && !is_whole) {
    refuse_term(field + ".from", "a part of a motion that repeats itself is not allowed; need all of it");
  }
}

/// A free duration would move the time of all later nodes.
void check_time(const MotionProblem& problem, const std::string& field, const TermUse& use) {
  const std::vector<Quantity>& reads = use.term->reads();
  if (std::ranges::count(reads, Quantity::Kind::time, &Quantity::kind) == 0) return;
  for (int p = 0; p <= use.to.phase; ++p) {
    if (problem.phases[p].duration.is_fixed()) continue;
    refuse_term(field + ".term", "reads the time, which the free duration of phase '{}' changes; need fixed durations",
                problem.phases[p].name);
  }
  if (problem.cycle && problem.cycle->count > 1) {
    refuse_term(field + ".term", "reads the time, which differs from cycle to cycle; need one cycle");
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

void check_weight(const std::string& field, const Eigen::MatrixXd& weight, int rows) {
  constexpr double kRounding = 1e-12;  // of the largest entry
  if (weight.rows() != rows || weight.cols() != rows) {
    refuse_term(field, "{} x {} entries are not allowed; need {} x {}", weight.rows(), weight.cols(), rows, rows);
  }
  if (!weight.allFinite()) refuse_term(field, "an entry that is not finite is not allowed");
  const double rounding = kRounding * weight.cwiseAbs().maxCoeff();
  for (int i = 0; i < rows; ++i) {
    for (int j = 0; j < i; ++j) {
      if (std::abs(weight(i, j) - weight(j, i)) <= rounding) continue;
      refuse_term(field, "is not symmetric: entry {}, {} is {}, entry {}, {} is {}", i, j, weight(i, j), j, i,
                  weight(j, i));
    }
  }
  const double least =
      Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(weight, Eigen::EigenvaluesOnly).eigenvalues().minCoeff();
  if (least < -rounding) {
    refuse_term(field, "is not positive semidefinite: an eigenvalue is {:.4g}; need none below zero", least);
  }
}

void check_term_cost(const std::string& field, const TermUse& use) {
  const int rows = use.term->num_rows();
  check_entries(field + ".lower", use.lower, 0);  // a cost has no bounds
  check_entries(field + ".upper", use.upper, 0);
  check_entries(field + ".reference", use.reference, rows);
  for (int row = 0; row < rows; ++row) {
    if (std::isfinite(use.reference(row))) continue;
    refuse_term(field + ".reference", "{} is not allowed; need a finite number", use.reference(row));
  }
  check_weight(field + ".weight", use.weight, rows);
}

/// The force of an open contact is zero whatever the motion.
void check_open_contacts(const MotionProblem& problem, const std::string& field, const TermUse& use) {
  const std::vector<Quantity>& reads = use.term->reads();
  const auto is_force = [](const Quantity& quantity) { return quantity.kind == Quantity::Kind::force; };
  if (use.is_cost() || !std::ranges::all_of(reads, is_force)) return;
  VectorXd f = VectorXd::Zero(use.term->num_rows());
  use.term->value(VectorXd::Zero(3 * std::ssize(reads)), f);
  for (int p = use.from.phase; p <= use.to.phase; ++p) {
    if (!use.holds_at(p, p == use.from.phase ? use.from.fraction : 0.0)) continue;
    const std::vector<int> held = contact_indices(problem.phases[p].contacts);
    const auto is_open = [&](const Quantity& quantity) {
      return std::ranges::count(held, problem.robot.contact_index(quantity.name)) == 0;
    };
    if (!std::ranges::all_of(reads, is_open)) continue;
    for (int row = 0; row < use.term->num_rows(); ++row) {
      const double outside = std::max(use.lower(row) - f(row), f(row) - use.upper(row));
      if (outside <= term_tolerance(problem, *use.term)) continue;
      refuse_term(field,
                  "in phase '{}' {} is {:.4g} {}, as contact {} is open, {:.4g} beyond its bound; need another phase",
                  problem.phases[p].name, use.term->rows()[row], f(row), use.term->unit(), reads.front().name, outside);
    }
  }
}

/// No later motion can change a fixed start.
void check_term_at_start(const MotionProblem& problem, const std::string& field, const TermUse& use,
                         const RigidBodyTerms& kinematics) {
  const BoundaryConstraint& start = problem.start();
  const bool is_known = start.fixes_configuration() && (start.fixes_velocity() || !reads_rates(*use.term));
  if (!is_known || reads_loads(*use.term) || !use.holds_at(0, 0.0)) return;
  TermEvaluation term(problem.robot, use, {});
  const VectorXd none;
  try {
    term.evaluate({kinematics, start.q_ref, start.velocity_lower, none, none, 0.0});
  } catch (const NumericalError& error) {
    refuse_term(field, "at the start: {}; need another start or reference", error.what());
  }
  if (use.is_cost()) return;
  for (int row = 0; row < use.term->num_rows(); ++row) {
    const double value = term.value()(row);
    const double outside = std::max(use.lower(row) - value, value - use.upper(row));
    if (outside <= term_tolerance(problem, *use.term)) continue;
    refuse_term(field, "at the start {} is {:.4g} {}, {:.4g} beyond its bound; need another start, or a later moment",
                use.term->rows()[row], value, use.term->unit(), outside);
  }
}

/// Every cycle must keep the limits and have the cost of the first.
void check_term_in_cycles(const MotionProblem& problem, const std::string& field, const TermUse& use) {
  constexpr double kSame = 1e-9;
  if (!problem.cycle || problem.cycle->count == 1) return;
  const RobotModel& robot = problem.robot;
  const std::vector<int> contacts = all_contacts(robot);
  TermEvaluation term(robot, use, contacts);
  RigidBodyTerms kinematics(robot);
  const VectorXd &q = problem.start_configuration(), ones = VectorXd::Ones(robot.nv());
  const VectorXd tau = mixed(robot.nu(), robot.weight() * robot.size());
  const VectorXd forces = mixed(3 * std::ssize(contacts), robot.weight());
  VectorXd turned = forces;
  for (auto force : turned.reshaped(3, std::ssize(contacts)).colwise())
    force = (problem.cycle->rotation() * force).eval();
  const auto value = [&](const VectorXd& at, const VectorXd& with) -> VectorXd {
    kinematics.update_kinematics(at);
    term.evaluate({kinematics, at, ones, tau, with, 0.0});
    return term.value();
  };
  VectorXd change;
  try {
    change = value(problem.cycle->moved_configuration(q), turned) - value(q, forces);
  } catch (const NumericalError& error) {
    refuse_term(field + ".term", "at the start: {}", error.what());
  }
  for (int row = 0; row < use.term->num_rows(); ++row) {
    const bool counts = use.is_cost() ? !use.weight.row(row).isZero(0.0)
                                      : std::isfinite(use.lower(row)) || std::isfinite(use.upper(row));
    if (!counts || std::abs(change(row)) <= kSame * natural_size(robot, *use.term)) continue;
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
    check_names(problem, field, *use.term);
    check_derivatives(problem, field, use);
    check_term_span(problem, field, use);
    check_time(problem, field, use);
    use.is_cost() ? check_term_cost(field, use) : check_limit(field, use);
    check_open_contacts(problem, field, use);
    check_term_at_start(problem, field, use, kinematics);
    check_term_in_cycles(problem, field, use);
  }
  if (const std::string what = contradicting_terms(problem); !what.empty()) throw InputError("terms: " + what);
}

}  // namespace prowl

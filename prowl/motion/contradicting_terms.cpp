#include "prowl/motion/contradicting_terms.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/terms/selected_entries.hpp"

namespace prowl {

namespace {

/// A limit of entries of one quantity.
struct EntryLimit {
  const TermUse& use;
  const SelectedEntries& term;
  const Quantity& quantity;
};

std::vector<EntryLimit> entry_limits(const MotionProblem& problem) {
  std::vector<EntryLimit> limits;
  for (const TermUse& use : problem.terms) {
    const auto* const term = dynamic_cast<const SelectedEntries*>(use.term.get());
    if (term && !use.is_cost()) limits.push_back({use, *term, term->reads().front()});
  }
  return limits;
}

/// The first moment at which it holds: after a phase transition that of the later phase.
PhaseFraction first_held(const TermUse& use) {
  return use.holds_at(use.from.phase, use.from.fraction) ? use.from : PhaseFraction::start_of(use.from.phase + 1);
}

/// Whether there is a time at which both hold; of loads, which may jump at a phase transition, one in a phase of both.
bool overlap(const TermUse& a, const TermUse& b) {
  if (!reads_loads(*a.term)) {
    const auto time = [](PhaseFraction at) { return at.phase + at.fraction; };
    return std::max(time(a.from), time(b.from)) <= std::min(time(a.to), time(b.to));
  }
  const PhaseFraction of_a = first_held(a), of_b = first_held(b);
  return a.holds_at(of_b.phase, of_b.fraction) || b.holds_at(of_a.phase, of_a.fraction);
}

/// The first entry for which the bounds of both leave nothing; empty if there is none.
std::string conflict(const EntryLimit& a, const EntryLimit& b, double tolerance) {
  for (int i = 0; i < a.term.num_rows(); ++i) {
    for (int j = 0; j < b.term.num_rows(); ++j) {
      if (a.term.entries()[i] != b.term.entries()[j]) continue;
      const double lower = std::max(a.use.lower(i), b.use.lower(j)), upper = std::min(a.use.upper(i), b.use.upper(j));
      if (lower - upper <= 2.0 * tolerance) continue;
      const std::string& unit = a.term.unit();
      return fmt::format("{} must be {:.6g} {} or more, and {:.6g} {} or less", a.term.rows()[i], lower, unit, upper,
                         unit);
    }
  }
  return {};
}

}  // namespace

std::string contradicting_terms(const MotionProblem& problem) {
  const std::vector<EntryLimit> limits = entry_limits(problem);
  for (std::size_t b = 0; b < limits.size(); ++b) {
    for (std::size_t a = 0; a < b; ++a) {
      const EntryLimit &one = limits[a], &other = limits[b];
      const bool is_same = one.quantity.kind == other.quantity.kind && one.quantity.name == other.quantity.name;
      if (!is_same || !overlap(one.use, other.use)) continue;
      const std::string what = conflict(one, other, term_tolerance(problem, one.term));
      if (what.empty()) continue;
      return fmt::format("terms '{}' and '{}' contradict each other: {} at one time", one.use.name, other.use.name,
                         what);
    }
  }
  return {};
}

}  // namespace prowl

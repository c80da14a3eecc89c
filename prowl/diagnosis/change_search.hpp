#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "prowl/diagnosis/change.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A knob, and the least amount with which the problem was solved.
struct FoundChange {
  Knob knob;
  double amount = 0.0;
  double weighted() const { return knob.weight * amount; }
};

struct ChangesFound {
  std::vector<FoundChange> found;  ///< sorted by weighted amount
  int tried = 0;                   ///< knobs that were turned
  bool out_of_time = false;        ///< some were not, or not as far as they could have been
};

/// Looks for small changes that make a problem solvable, by solving it again and again on its mesh, until the time is
/// up.
class ChangeSearch {
 public:
  ChangeSearch(const NlpSolver& solver, const SolverOptions& options, double max_seconds)
      : solver_(solver), options_(options), end_(wall_seconds() + max_seconds) {}
  /// The same search, which ends after that part of the time that is left.
  ChangeSearch within(double part) const;

  double seconds_left() const { return end_ - wall_seconds(); }
  /// What a solve may take: a part of the time that is left, at most so many seconds, but never no time at all.
  double seconds_of_solve(double part = 1.0, double most = std::numeric_limits<double>::infinity()) const;
  bool interrupted() const { return options_.interrupt && options_.interrupt->load(); }
  bool may_go_on() const { return seconds_left() > 0.0 && !interrupted(); }

  /// What the solver converges to on the problem's mesh from its guess. None if it does not, if there is a proof
  /// against it, or the time is up.
  std::optional<Trajectory> motion(const DiscreteProblem& discrete) const;
  /// Whether there is one in which contacts stay where they are: on a coarse mesh they may drift by centimetres in
  /// between the nodes, and what needs that has no plan.
  bool solves(const DiscreteProblem& discrete) const;
  /// The same of the problem with a knob turned, on that mesh.
  bool solves(const Knob& knob, double amount, const Mesh& mesh) const;

  /// All knobs are turned a little, then further and further, each until its problem is solved; then between the last
  /// two amounts by bisection. Ends where what is left would be no match for the smallest, or when the time is up.
  ChangesFound smallest(const std::vector<Knob>& knobs, const Mesh& mesh,
                        const std::function<void(const std::string&)>& on_step) const;

 private:
  double bisected(const Knob& knob, double too_little, double enough, const Mesh& mesh) const;

  const NlpSolver& solver_;
  SolverOptions options_;
  double end_;  ///< in wall_seconds()
};

}  // namespace prowl

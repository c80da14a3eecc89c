#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "prowl/diagnosis/adjustable_parameter.hpp"
#include "prowl/mesh/discrete_problem.hpp"
#include "prowl/nlp/nlp_solver.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/trajectory/trajectory.hpp"

namespace prowl {

/// A parameter and the smallest amount with which the problem was solved.
struct FoundChange {
  AdjustableParameter parameter;
  double amount = 0.0;
  double weighted() const { return parameter.weight * amount; }
};

struct ChangesFound {
  std::vector<FoundChange> found;  ///< sorted by weighted amount
  int tried = 0;                   ///< number of parameters
  bool out_of_time = false;        ///< some parameters were not tried, or not up to their largest amount
};

/// Looks for small changes that make a problem solvable: solves it on its mesh again and again until the time is up.
class ChangeSearch {
 public:
  ChangeSearch(const NlpSolver& solver, const SolverOptions& options, double max_seconds)
      : solver_(solver), options_(options), end_(wall_seconds() + max_seconds) {}
  /// The same search with that part of the remaining time.
  ChangeSearch within(double part) const;

  double seconds_left() const { return end_ - wall_seconds(); }
  /// Time limit of a solve [s]: a part of the remaining time, at most `most`, never zero.
  double seconds_of_solve(double part = 1.0, double most = std::numeric_limits<double>::infinity()) const;
  bool interrupted() const { return options_.interrupt && options_.interrupt->load(); }
  bool may_go_on() const { return seconds_left() > 0.0 && !interrupted(); }

  /// Solution on the problem's mesh, from its initial guess. None if the solver does not converge, a proof excludes it,
  /// or the time is up.
  std::optional<Trajectory> motion(const DiscreteProblem& discrete) const;
  /// True if there is a solution whose contacts hold still. On a coarse mesh they may drift by centimetres between the
  /// nodes; such a motion has no plan.
  bool solves(const DiscreteProblem& discrete) const;
  /// The same with a parameter turned, on that mesh.
  bool solves(const AdjustableParameter& parameter, double amount, const Mesh& mesh) const;

  /// Turns all parameters a little, then further and further, each until its problem is solved; then bisects between
  /// its last two amounts. Ends when larger amounts cannot compete with the smallest, or the time is up.
  ChangesFound smallest(const std::vector<AdjustableParameter>& parameters, const Mesh& mesh,
                        const std::function<void(const std::string&)>& on_step) const;

 private:
  double bisected(const AdjustableParameter& parameter, double too_little, double enough, const Mesh& mesh) const;

  const NlpSolver& solver_;
  SolverOptions options_;
  double end_;  ///< in wall_seconds()
};

}  // namespace prowl

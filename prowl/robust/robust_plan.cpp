#include "prowl/robust/robust_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solve_books.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;

constexpr int kMostSolves = 8;            // rough ones: then a robust plan takes about three times a nominal one
constexpr int kMostIterations = 40;       // of each: margins with a motion take up to 30
constexpr double kLooseTolerance = 1e-4;  // of each: the tube of a motion does not need more
constexpr double kMissing = 0.2;          // part that a margin may lack: the next tube would differ by as much
// Shares of the sizes: the first, as a multiple of what the nominal motion has, and at most; the next after one without
// a motion; the least; the smallest step.
constexpr double kFirst = 1.7, kSmaller = 0.6, kLeastShare = 0.1, kStep = 0.1;

/// Sizes of limits below this part of the largest of their kind in a phase count as so large: solvers do not see less.
constexpr double kSmallest = 0.1;

/// Part of the sizes for which a motion leaves the margins that its tube needs, and the limit that allows no more.
struct HeldShare {
  double share = std::numeric_limits<double>::infinity();
  std::string where;
};

HeldShare held_share(const MotionProblem& problem, const Tube& tube) {
  HeldShare least;
  for (std::size_t p = 0; p < tube.phases.size(); ++p) {
    const Tube::OfPhase& phase = tube.phases[p];
    const auto look = [&](const MatrixXd& needed, const MatrixXd& left, const auto& name) {
      if (needed.size() == 0) return;
      for (Eigen::Index row = 0; row < needed.rows(); ++row) {
        const double largest = std::max(needed.row(row).maxCoeff(), kSmallest * needed.maxCoeff());
        for (Eigen::Index k = 0; k < needed.cols(); ++k) {
          const double asked = needed(row, k) - kMissing * largest;
          if (asked <= 0.0) continue;
          const double share = std::max(left(row, k), 0.0) / asked;
          if (share >= least.share) continue;
          least = {share, fmt::format("{} at {:.2f} s in phase '{}'", name(row),
                                      phase.times[static_cast<std::size_t>(k)], problem.phases[p].name)};
        }
      }
    };
    look(phase.cone_needed(), phase.cone_left, [&](Eigen::Index row) {
      const PhaseContact& held = problem.phases[p].contacts[static_cast<std::size_t>(row)];
      return "friction cone of " + problem.robot.contacts()[static_cast<std::size_t>(held.contact)].name;
    });
    look(phase.needed.torque, phase.torque_left,
         [&](Eigen::Index row) { return "torque of " + problem.robot.joint_names()[static_cast<std::size_t>(row)]; });
    look(phase.needed.clearance, phase.height, [&](Eigen::Index row) {
      return "clearance of " + problem.robot.contacts()[static_cast<std::size_t>(row)].name;
    });
  }
  return least;
}

/// Share of the sizes for which the cones of all feet together have what they need, however the loads are shared out.
double share_to_begin_with(const Tube& tube) {
  double share = 1.0;
  for (const Tube::OfPhase& phase : tube.phases) {
    if (phase.cone_left.rows() == 0) continue;
    const Eigen::RowVectorXd left = phase.cone_left.colwise().sum(), needed = phase.cone_needed().colwise().sum();
    share = std::min(share, (left.array() / needed.array().max(1e-9)).minCoeff());
  }
  return std::clamp(kFirst * share, kLeastShare, kSmaller);
}

Margins margins_of(const Tube& tube, const Disturbances& sizes, double share) {
  Margins margins{.friction = share * sizes.friction, .phases = {}};
  for (const Tube::OfPhase& phase : tube.phases)
    margins.phases.push_back({share * phase.needed.cone, share * phase.needed.torque, share * phase.needed.joint,
                              share * phase.needed.clearance});
  return margins;
}

/// Options of the next solve, from the motion before.
PlanOptions options_from(const Plan& before, const PlanOptions& options, bool refines, double seconds) {
  PlanOptions next = options;
  next.solver.max_seconds = seconds;
  next.warm_start = before.trajectory;
  next.warm_start_multipliers.clear();
  next.elastic_solver = {};
  next.resume = false;
  next.corrected = refines;
  next.coarse_first = false;
  return next;
}

/// What `make` returns; nothing where margins leave nothing between two limits, or a motion has no gains.
template <typename Make>
auto unless_impossible(const Make& make) -> decltype(make()) {
  try {
    return make();
  } catch (const InputError&) {
  } catch (const NumericalError&) {
  }
  return std::nullopt;
}

/// A motion that keeps the margins of another one's tube.
struct Candidate {
  Plan plan;
  MotionProblem asked;
  Tube tube;    ///< its own
  double held;  ///< share that its own tube leaves
};

/// Looks for margins that have a motion, for ever larger shares of the sizes, by loose solves on a coarse mesh.
class Search {
 public:
  /// `seconds_left`: of all solves.
  Search(const DiscreteProblem& asked, const Plan& nominal, const TrackingOptions& tracking, const Disturbances& sizes,
         const NlpSolver& solver, const PlanOptions& options, bool refines, std::function<double()> seconds_left)
      : asked_(asked),
        nominal_(nominal),
        tracking_(tracking),
        sizes_(sizes),
        solver_(solver),
        options_(options),
        refines_(refines),
        seconds_left_(std::move(seconds_left)) {
    books_.add(nominal);
    options_.solver.max_iterations = std::min(options.solver.max_iterations, kMostIterations);
    options_.solver.tolerance = std::max(options.solver.tolerance, kLooseTolerance);
  }

  /// `first`: tube of the nominal motion. Empty: that motion has all margins, or no margins have a motion.
  std::vector<Candidate> run(const Tube& first) {
    double share = share_to_begin_with(first);
    double kept = 0.0, none = std::numeric_limits<double>::infinity();  // largest with a motion, smallest without
    std::vector<Candidate> found;
    while (share >= kLeastShare && solves_ < kMostSolves && !is_stopped_ && seconds_left_() > 0.0) {
      const bool is_last = share == kept;  // with the tube of a motion that keeps this share of the one before
      const Tube& tube = found.empty() ? first : found.back().tube;
      if (held_share(asked_.problem, tube).share >= share) {
        kept = share;
      } else if (std::optional<Candidate> next = keep(margins_of(tube, sizes_, share), found)) {
        found.push_back(std::move(*next));
        kept = share;
      } else {
        none = share;
      }
      if (is_last) return found;
      if (kept == 1.0 || none - kept < kStep)
        share = kept;
      else if (std::isfinite(none))
        share = kept > 0.0 ? 0.5 * (kept + none) : kSmaller * none;
      else
        share = std::min(1.0, kept / kSmaller);
    }
    return found;
  }

  int solves() const { return solves_; }
  bool was_stopped() const { return is_stopped_; }
  SolveBooks& books() { return books_; }

 private:
  /// From the last of those before. None where there is no motion.
  std::optional<Candidate> keep(Margins margins, const std::vector<Candidate>& before) {
    MotionProblem tighter = asked_.problem;
    tighter.margins = std::move(margins);
    return unless_impossible([&]() -> std::optional<Candidate> {
      Plan plan = solve(tighter, before.empty() ? nullptr : &before.back().plan);
      is_stopped_ = is_stopped(plan.result.status);
      if (plan.result.status != SolveStatus::converged) return std::nullopt;
      Tube tube = make_tube(asked_.problem, plan.trajectory, tracking_, sizes_);
      const double held = held_share(asked_.problem, tube).share;
      return Candidate{std::move(plan), std::move(tighter), std::move(tube), held};
    });
  }

  /// From the motion before; the first, where that fails, from the task.
  Plan solve(const MotionProblem& tighter, const Plan* before) {
    const DiscreteProblem program(tighter, refines_ ? asked_.mesh : nominal_.mesh);
    PlanOptions options = options_from(before ? *before : nominal_, options_, refines_, seconds_left_());
    Plan plan = solve_plan(program, solver_, options);
    books_.add(plan);
    ++solves_;
    if (before || !has_failed(plan.result.status)) return plan;
    options.warm_start = {};
    options.corrected = false;
    options.solver.max_seconds = seconds_left_();
    ++solves_;
    plan = solve_plan(program, solver_, options);
    books_.add(plan);
    return plan;
  }

  const DiscreteProblem& asked_;
  const Plan& nominal_;
  const TrackingOptions& tracking_;
  const Disturbances& sizes_;
  const NlpSolver& solver_;
  PlanOptions options_;
  bool refines_;
  std::function<double()> seconds_left_;
  SolveBooks books_;
  int solves_ = 0;
  bool is_stopped_ = false;
};

}  // namespace

RobustPlan make_robust_plan(const DiscreteProblem& asked, Plan nominal, const TrackingOptions& tracking,
                            const Disturbances& sizes, const NlpSolver& solver, const PlanOptions& options,
                            const std::optional<RefineOptions>& refine) {
  const MotionProblem& problem = asked.problem;
  const auto seconds_left = [limit = options.solver.max_seconds, begin = wall_seconds() - nominal.result.seconds] {
    return limit - (wall_seconds() - begin);
  };
  Search search(asked, nominal, tracking, sizes, solver, options, refine.has_value(), seconds_left);
  const Tube first = make_tube(problem, nominal.trajectory, tracking, sizes);
  std::vector<Candidate> candidates = search.run(first);
  std::ranges::stable_sort(candidates, {}, &Candidate::held);
  struct Exact {
    Plan plan;
    HeldShare held;
  };
  const auto refined = [&](const Candidate& rough) -> std::optional<Exact> {
    const PlanOptions last = options_from(rough.plan, options, refine.has_value(), seconds_left());
    const DiscreteProblem program(rough.asked, rough.plan.mesh);
    Plan plan = refine ? make_refined_plan(program, solver, last, *refine).plan : make_plan(program, solver, last);
    search.books().add(plan);
    if (!is_good(plan)) return std::nullopt;
    HeldShare held = held_share(problem, make_tube(problem, plan.trajectory, tracking, sizes));
    return Exact{std::move(plan), std::move(held)};
  };
  Exact best{nominal, held_share(problem, first)};
  // The one that holds most and is as exact as the nominal one. A finer mesh may see margins that leave nothing.
  for (; !candidates.empty() && seconds_left() > 0.0; candidates.pop_back()) {
    std::optional<Exact> exact = unless_impossible([&] { return refined(candidates.back()); });
    if (!exact) continue;
    if (exact->held.share > best.held.share) best = std::move(*exact);
    break;
  }
  search.books().enter(best.plan);
  Robustness robustness{sizes, std::min(best.held.share, 1.0), search.solves(), std::move(best.held.where)};
  const bool is_stopped = !robustness.is_full() && (search.was_stopped() || seconds_left() <= 0.0);
  if (is_stopped) best.plan.hints.push_back("with more time (--max-time) the motion may become more robust");
  return {std::move(best.plan), std::move(robustness), is_stopped};
}

}  // namespace prowl

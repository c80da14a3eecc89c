#include "prowl/robust/robust_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "prowl/nlp/stopwatch.hpp"
#include "prowl/solve_books.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;

constexpr int kMostSolves = 8;            // rough ones: then a robust plan takes about three times a nominal one
constexpr int kMostIterations = 40;       // of each: margins with a motion take up to 30
constexpr double kLooseTolerance = 1e-4;  // of each: the tube of a motion does not need more
constexpr int kTubes = 2;                 // for one share: a third would differ by less than a fifth of a margin
constexpr double kEnough = 0.2;           // missing part of a margin: the next tube would differ by as much
// Shares of the sizes: the first, as a multiple of what the nominal motion has, and at most; the next after one without
// a motion; the least; the smallest step, and that of the share that is told.
constexpr double kFirst = 1.7, kSmaller = 0.6, kLeastShare = 0.1, kStep = 0.1, kResolution = 0.01;

/// What a motion lacks of a margin.
struct Lack {
  double part = 0.0;  ///< of the largest margin of that limit in the phase
  std::string where;
};

/// Left of the cones with less friction.
MatrixXd cones_left(const MotionProblem& problem, const Tube& tube, std::size_t p, double friction) {
  MatrixXd left = tube.phases[p].cone_left;
  for (Eigen::Index i = 0; i < left.rows(); ++i) {
    const PhaseContact& held = problem.phases[p].contacts[static_cast<std::size_t>(i)];
    const double coefficient = problem.surfaces[static_cast<std::size_t>(held.surface)].friction;
    left.row(i) -= friction * coefficient * tube.phases[p].load.row(i);
  }
  return left;
}

Lack largest_lack(const MotionProblem& problem, const Tube& tube, const Disturbances& sizes, double share) {
  Lack worst{.part = -std::numeric_limits<double>::infinity(), .where = ""};
  for (std::size_t p = 0; p < tube.phases.size(); ++p) {
    const Tube::OfPhase& phase = tube.phases[p];
    const auto look = [&](const MatrixXd& needed, const MatrixXd& left, const auto& name) {
      if (needed.size() == 0 || needed.maxCoeff() <= 0.0) return;
      Eigen::Index row = 0, sample = 0;
      const double lack = (share * needed - left).maxCoeff(&row, &sample) / (share * needed.maxCoeff());
      if (lack <= worst.part) return;
      worst = {lack, fmt::format("{} at {:.2f} s in phase '{}'", name(row),
                                 phase.times[static_cast<std::size_t>(sample)], problem.phases[p].name)};
    };
    look(phase.needed.cone, cones_left(problem, tube, p, share * sizes.friction), [&](Eigen::Index row) {
      const PhaseContact& held = problem.phases[p].contacts[static_cast<std::size_t>(row)];
      return "friction cone of " + problem.robot.contacts()[static_cast<std::size_t>(held.contact)].name;
    });
    look(phase.needed.torque, phase.torque_left,
         [&](Eigen::Index row) { return "torque of " + problem.robot.joint_names()[static_cast<std::size_t>(row)]; });
    look(phase.needed.clearance, phase.height, [&](Eigen::Index row) {
      return "clearance of " + problem.robot.contacts()[static_cast<std::size_t>(row)].name;
    });
  }
  return worst;
}

/// Share of the sizes for which the cones of all feet together have what they need, however the loads are shared out.
double share_to_begin_with(const MotionProblem& problem, const Tube& tube, const Disturbances& sizes) {
  double share = 1.0;
  for (std::size_t p = 0; p < tube.phases.size(); ++p) {
    if (tube.phases[p].needed.cone.rows() == 0) continue;
    const Eigen::RowVectorXd left = cones_left(problem, tube, p, 0.0).colwise().sum();
    const Eigen::RowVectorXd needed = tube.phases[p].needed.cone.colwise().sum() + left -
                                      cones_left(problem, tube, p, sizes.friction).colwise().sum();
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

/// A motion that keeps margins.
struct Candidate {
  Plan plan;
  MotionProblem asked;
  double share;
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
    tracking_.step = std::max(tracking.step, kTubeStep);
    options_.solver.max_iterations = std::min(options.solver.max_iterations, kMostIterations);
    options_.solver.tolerance = std::max(options.solver.tolerance, kLooseTolerance);
  }

  /// In order of their shares; empty: the nominal motion has all margins, or no margins have a motion.
  std::vector<Candidate> run() {
    Tube tube = closed_loop(asked_.problem, nominal_.trajectory, tracking_, sizes_).tube;
    double share = share_to_begin_with(asked_.problem, tube, sizes_);
    double kept = 0.0, none = std::numeric_limits<double>::infinity();  // largest with a motion, smallest without
    std::vector<Candidate> found;
    while (true) {
      const bool is_tried = std::ranges::count(found, share, &Candidate::share) == kTubes;
      if (is_tried || largest_lack(asked_.problem, tube, sizes_, share).part <= kEnough) {
        kept = share;
        if (kept == 1.0 || none - kept < kStep) return found;
        share = std::isfinite(none) ? 0.5 * (kept + none) : std::min(1.0, kept / kSmaller);
        continue;
      }
      if (solves_ == kMostSolves || seconds_left_() <= 0.0) return found;
      MotionProblem tighter = asked_.problem;
      tighter.margins = margins_of(tube, sizes_, share);
      Plan plan = solve(tighter, found.empty() ? nullptr : &found.back().plan);
      if (plan.result.status == SolveStatus::converged) {
        tube = closed_loop(asked_.problem, plan.trajectory, tracking_, sizes_).tube;
        found.push_back({std::move(plan), std::move(tighter), share});
        continue;
      }
      none = share;
      share = kept > 0.0 ? 0.5 * (kept + none) : kSmaller * none;
      if (is_stopped(plan.result.status) || none - kept < kStep || share < kLeastShare) return found;
    }
  }

  int solves() const { return solves_; }
  SolveBooks& books() { return books_; }

 private:
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
    plan = solve_plan(program, solver_, options);
    books_.add(plan);
    return plan;
  }

  const DiscreteProblem& asked_;
  const Plan& nominal_;
  TrackingOptions tracking_;
  const Disturbances& sizes_;
  const NlpSolver& solver_;
  PlanOptions options_;
  bool refines_;
  std::function<double()> seconds_left_;
  SolveBooks books_;
  int solves_ = 0;
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
  std::vector<Candidate> candidates = search.run();
  Plan best = nominal;
  Robustness found{.sizes = sizes, .share = 1.0, .solves = search.solves(), .tightest = ""};
  // The one with the largest share that is as exact as the nominal one.
  for (; !candidates.empty() && seconds_left() > 0.0; candidates.pop_back()) {
    const Candidate& rough = candidates.back();
    const PlanOptions last = options_from(rough.plan, options, refine.has_value(), seconds_left());
    const DiscreteProblem program(rough.asked, rough.plan.mesh);
    Plan plan = refine ? make_refined_plan(program, solver, last, *refine).plan : make_plan(program, solver, last);
    search.books().add(plan);
    if (!is_good(plan)) continue;
    best = std::move(plan);
    found.share = rough.share;
    break;
  }
  ClosedLoop loop = closed_loop(problem, best.trajectory, tracking, sizes);
  // What the plan has, by its own tube.
  const auto is_robust = [&](double share) { return largest_lack(problem, loop.tube, sizes, share).part <= kEnough; };
  if (!is_robust(found.share)) {
    double most = found.share;
    found.share = 0.0;
    while (most - found.share > kResolution) {
      const double middle = 0.5 * (found.share + most);
      (is_robust(middle) ? found.share : most) = middle;
    }
  }
  found.tightest = largest_lack(problem, loop.tube, sizes, 1.0).where;
  search.books().enter(best);
  return {std::move(best), std::move(loop.feedback), std::move(found)};
}

}  // namespace prowl

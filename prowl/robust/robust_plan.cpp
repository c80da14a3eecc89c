#include "prowl/robust/robust_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "prowl/nlp/stopwatch.hpp"

namespace prowl {
namespace {

using Eigen::MatrixXd;

constexpr int kMostSolves = 3;       // with margins: a robust plan shall not take much longer than three nominal ones
constexpr int kMostIterations = 60;  // of each: margins without a motion take many
constexpr double kEnough = 0.2;      // missing part of a margin: the next tube would differ by as much
/// A motion with larger margins that costs so much more is another one: HyQ's walk then pitches by 1.1 rad/s and falls.
constexpr double kAnother = 1.6;
// Shares of the sizes: the first, as a multiple of what the nominal motion has; the next after one with a motion, and
// after one without.
constexpr double kFirst = 1.7, kLarger = 1.6, kSmaller = 0.6, kLeastShare = 0.1;
constexpr double kResolution = 0.01;  // of the share that is told

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
  return std::clamp(kFirst * share, kLeastShare, 1.0);
}

Margins margins_of(const Tube& tube, const Disturbances& sizes, double share) {
  Margins margins{.friction = share * sizes.friction, .phases = {}};
  for (const Tube::OfPhase& phase : tube.phases)
    margins.phases.push_back({share * phase.needed.cone, share * phase.needed.torque, share * phase.needed.joint});
  return margins;
}

/// A motion's gains, and where they let it go.
struct ClosedLoop {
  FeedbackDesign feedback;
  Tube tube;
};

ClosedLoop closed_loop(const MotionProblem& problem, const Plan& plan, const TrackingOptions& tracking,
                       const Disturbances& sizes) {
  TubeDesign design(problem, tracking, sizes);
  FeedbackDesign feedback =
      design_feedback(problem, plan.trajectory, tracking, [&](const ReducedSample& sample) { design.add(sample); });
  return {std::move(feedback), design.propagate()};
}

/// Options of the solves with margins, from the motion before.
PlanOptions with_margins(const PlanOptions& options, const Plan& before, bool refines, double seconds_left) {
  PlanOptions next = options;
  next.solver.max_seconds = seconds_left;
  next.solver.max_iterations = std::min(options.solver.max_iterations, kMostIterations);
  next.warm_start = before.trajectory;
  next.warm_start_multipliers.clear();
  next.elastic_solver = {};
  next.resume = false;
  next.corrected = refines;
  next.coarse_first = false;
  return next;
}

/// Books of all solves in the plan that is returned.
void add_books(const Plan& of, Plan& to) {
  to.levels.insert(to.levels.begin(), of.levels.begin(), of.levels.end());
  to.result.iterations += of.result.iterations;
  to.result.seconds += of.result.seconds;
  to.result.times += of.result.times;
}

}  // namespace

RobustPlan make_robust_plan(const MotionProblem& problem, Plan nominal, const TrackingOptions& tracking,
                            const Disturbances& sizes, const NlpSolver& solver, const PlanOptions& options,
                            const std::optional<RefineOptions>& refine) {
  const double begin = wall_seconds() - nominal.result.seconds;
  ClosedLoop loop = closed_loop(problem, nominal, tracking, sizes);
  Plan best = std::move(nominal);
  Robustness found{.sizes = sizes, .tightest = ""};
  const auto is_robust = [&](double at) { return largest_lack(problem, loop.tube, sizes, at).part <= kEnough; };
  double share = share_to_begin_with(problem, loop.tube, sizes);
  bool has_margins = false;
  while (true) {
    if (is_robust(share)) {
      found.share = share;
      if (share == 1.0) break;
      share = std::min(1.0, kLarger * share);
      continue;
    }
    const double seconds_left = options.solver.max_seconds - (wall_seconds() - begin);
    if (found.solves == kMostSolves || seconds_left <= 0.0) break;
    const PlanOptions next = with_margins(options, best, refine.has_value(), seconds_left);
    MotionProblem tighter = problem;
    tighter.margins = margins_of(loop.tube, sizes, share);
    const DiscreteProblem asked(std::move(tighter), best.mesh);
    Plan plan = refine ? make_refined_plan(asked, solver, next, *refine).plan : make_plan(asked, solver, next);
    ++found.solves;
    const bool is_another = has_margins && plan.result.cost > kAnother * best.result.cost;
    if (is_good(plan) && !is_another) {
      add_books(best, plan);
      best = std::move(plan);
      has_margins = true;
      loop = closed_loop(problem, best, tracking, sizes);
      found.share = share;
      continue;
    }
    add_books(plan, best);
    share *= kSmaller;
    if (plan.result.status == SolveStatus::interrupted || found.share > 0.0 || share < kLeastShare) break;
  }
  // What the plan has, by its own tube.
  if (!is_robust(found.share)) {
    double most = found.share;
    found.share = 0.0;
    while (most - found.share > kResolution) {
      const double middle = 0.5 * (found.share + most);
      (is_robust(middle) ? found.share : most) = middle;
    }
  }
  found.tightest = largest_lack(problem, loop.tube, sizes, 1.0).where;
  return {std::move(best), std::move(loop.feedback), std::move(found)};
}

}  // namespace prowl

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
// Shares of the sizes: the first, as a multiple of what the nominal motion has; the next after one with a motion, and
// after one without.
/// A motion with larger margins that costs so much more is another one: HyQ's walk then pitches by 1.1 rad/s and falls.
constexpr double kAnother = 1.6;
constexpr double kResolution = 0.01;  // of the share that is told
constexpr double kFirst = 1.7, kLarger = 1.6, kSmaller = 0.6, kLeastShare = 0.1;

/// What a motion lacks of a margin.
struct Lack {
  double part = 0.0;  ///< of the largest margin of that limit in the phase
  std::string where;
};

/// Left of the cones with less friction.
MatrixXd cones_left(const MotionProblem& problem, const Tube& tube, std::size_t p, double friction) {
  MatrixXd left = tube.phases[p].left.cone;
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
    look(phase.needed.torque, phase.left.torque,
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

Tube tube_of(const MotionProblem& problem, const Plan& plan, const TrackingOptions& tracking,
             const Disturbances& sizes) {
  TubeDesign design(problem, tracking, sizes);
  design_feedback(problem, plan.trajectory, tracking, [&](const ReducedSample& sample) { design.add(sample); });
  return design.propagate();
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
  Tube tube = tube_of(problem, nominal, tracking, sizes);
  RobustPlan best{.plan = std::move(nominal), .robustness = {.sizes = sizes, .tightest = ""}};
  double share = share_to_begin_with(problem, tube, sizes);
  Robustness& found = best.robustness;
  bool has_margins = false;
  const auto is_robust = [&](double at) { return largest_lack(problem, tube, sizes, at).part <= kEnough; };
  while (true) {
    if (is_robust(share)) {
      found.share = share;
      if (share == 1.0) break;
      share = std::min(1.0, kLarger * share);
      continue;
    }
    PlanOptions next = options;
    next.solver.max_seconds = options.solver.max_seconds - (wall_seconds() - begin);
    if (found.solves == kMostSolves || next.solver.max_seconds <= 0.0) break;
    next.solver.max_iterations = std::min(options.solver.max_iterations, kMostIterations);
    next.warm_start = best.plan.trajectory;
    next.warm_start_multipliers.clear();
    next.elastic_solver = {};
    next.resume = false;
    next.corrected = refine.has_value();
    next.coarse_first = false;
    MotionProblem with_margins = problem;
    with_margins.margins = margins_of(tube, sizes, share);
    const DiscreteProblem asked(std::move(with_margins), best.plan.mesh);
    Plan plan = refine ? make_refined_plan(asked, solver, next, *refine).plan : make_plan(asked, solver, next);
    ++found.solves;
    const bool is_another = has_margins && plan.result.cost > kAnother * best.plan.result.cost;
    if (is_good(plan) && !is_another) {
      add_books(best.plan, plan);
      best.plan = std::move(plan);
      has_margins = true;
      tube = tube_of(problem, best.plan, tracking, sizes);
      found.share = share;
    } else {
      add_books(plan, best.plan);
      if (plan.result.status == SolveStatus::interrupted || found.share > 0.0) break;
      share *= kSmaller;
      if (share < kLeastShare) break;
    }
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
  found.tightest = largest_lack(problem, tube, sizes, 1.0).where;
  return best;
}

}  // namespace prowl

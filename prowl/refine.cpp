#include "prowl/refine.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

#include "prowl/mesh/first_mesh.hpp"
#include "prowl/mesh/mesh_levels.hpp"
#include "prowl/mesh/mesh_refinement.hpp"
#include "prowl/nlp/stopwatch.hpp"

namespace prowl {
namespace {

constexpr int kPatience = 3;           // rounds without progress: some pass before all kinks of a motion are found
constexpr double kWorthMerging = 0.8;  // of the intervals: saving fewer is not worth another solve

bool is_within(const MeshTolerance& errors, const MeshTolerance& tolerance) {
  return errors.local <= tolerance.local && errors.second <= tolerance.second &&
         errors.reintegration <= tolerance.reintegration;
}

bool has_failed(SolveStatus status) { return status != SolveStatus::converged && !is_stopped(status); }

/// A plan with the errors of its mesh.
struct Candidate {
  Plan plan;
  std::vector<double> parts = {};
  bool meets_tolerance = false;

  int intervals() const { return static_cast<int>(parts.size()); }
  double worst() const { return *std::ranges::max_element(parts); }
  int too_coarse() const {
    return static_cast<int>(std::ranges::count_if(parts, [](double part) { return part > 1.0; }));
  }

  void measure_errors(const MeshTolerance& tolerance) {
    parts = error_parts(plan.certificate, tolerance);
    meets_tolerance = is_within(mesh_errors(plan.certificate), tolerance);
  }
  /// A passed certificate comes before a met tolerance: other checks count, too.
  bool is_better_than(const Candidate& other) const {
    const auto rank = [](const Candidate& of) {
      return std::pair(of.meets_tolerance && of.plan.certificate.passed, of.meets_tolerance);
    };
    if (rank(*this) != rank(other)) return rank(*this) > rank(other);
    return meets_tolerance ? intervals() < other.intervals() : worst() < other.worst();
  }
};

/// Solves one mesh after the other, each from the motion of the last, and adds up times and iterations.
class Meshes {
 public:
  Meshes(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options)
      : asked_(asked), solver_(solver), options_(options) {
    options_.coarse_first = false;
  }

  /// Includes certificates, which take seconds on a fine mesh.
  bool is_time_over() const { return seconds_left() <= 0.0; }

  Candidate solve(const Mesh& mesh) {
    constexpr double kShortestSeconds = 1e-3;  // for the first mesh, with any limit
    PlanOptions options = options_;
    options.solver.max_seconds = std::max(seconds_left(), kShortestSeconds);
    std::optional<DiscreteProblem> other;  // asked_ is prepared already
    if (mesh != asked_.mesh) other.emplace(asked_.problem, mesh);
    Plan plan = make_plan(other ? *other : asked_, solver_, options);
    levels_.insert(levels_.end(), plan.levels.begin(), plan.levels.end());
    total_.iterations += plan.result.iterations;
    total_.seconds += plan.result.seconds;
    total_.times += plan.result.times;
    return {std::move(plan)};
  }
  /// From the motion on a coarser mesh, solved or stopped.
  Candidate solve_from(const Plan& plan, const Mesh& mesh) {
    options_.warm_start = plan.trajectory;
    options_.resume = plan.result.status != SolveStatus::converged;
    options_.warm_start_multipliers.clear();
    return solve(mesh);
  }
  Candidate solve_from_task(const Mesh& mesh) {
    options_.warm_start = {};
    options_.warm_start_multipliers.clear();
    options_.resume = false;
    return solve(mesh);
  }
  /// The first of these meshes that converges; each starts from the one before, as in make_plan().
  Candidate begin(const std::vector<Mesh>& meshes) {
    std::optional<Candidate> first;
    for (const Mesh& level : meshes) {
      const bool goes_on = first && is_worth_going_on_from(first->plan.result.status);
      first = goes_on ? solve_from(first->plan, level) : first ? solve_from_task(level) : solve(level);
      if (!has_failed(first->plan.result.status) || !first->plan.reasons.empty()) break;
    }
    return std::move(*first);
  }
  /// Replaces times and iterations of one mesh by those of all.
  void enter_books(Plan& plan) const {
    plan.levels = levels_;
    plan.result.iterations = total_.iterations;
    plan.result.seconds = total_.seconds;
    plan.result.times = total_.times;
  }

 private:
  double seconds_left() const { return options_.solver.max_seconds - (wall_seconds() - begin_); }

  const DiscreteProblem& asked_;
  const NlpSolver& solver_;
  PlanOptions options_;
  double begin_ = wall_seconds();
  SolveResult total_;
  std::vector<LevelResult> levels_;
};

/// Tests for progress: the tolerance on fewer intervals, fewer coarse intervals, or a clearly smaller worst error.
class Progress {
 public:
  bool is_over(const Candidate& now) {
    constexpr double kClearly = 0.9;
    const bool is_nearer = now.too_coarse() < fewest_ || now.worst() < kClearly * least_;
    const bool is_better = now.meets_tolerance ? now.intervals() < shortest_ : is_nearer;
    if (now.meets_tolerance) shortest_ = std::min(shortest_, now.intervals());
    fewest_ = std::min(fewest_, now.too_coarse());
    least_ = std::min(least_, now.worst());
    rounds_without_ = is_better ? 0 : rounds_without_ + 1;
    return rounds_without_ == kPatience;
  }

 private:
  static constexpr int kMost = std::numeric_limits<int>::max();
  int shortest_ = kMost, fewest_ = kMost, rounds_without_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
};

/// Meshes to begin on, until one converges.
std::vector<Mesh> first_meshes(const DiscreteProblem& asked, const PlanOptions& options, const RefineOptions& refine) {
  if (!options.coarse_first || !options.warm_start.empty()) return {asked.mesh};
  if (refine.ends_when_met) return {asked.mesh, split(asked.mesh, 2), split(asked.mesh, 4)};
  return mesh_levels(asked.problem, asked.mesh);
}

std::string hint(const Candidate& best, const std::string& stopped) {
  return fmt::format(
      "mesh refinement stopped, {}: errors of {} of {} intervals exceed the tolerance, the worst is {:.3g} times the "
      "tolerance",
      stopped, best.too_coarse(), best.intervals(), best.worst());
}

}  // namespace

RefinedPlan make_refined_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options,
                              const RefineOptions& refine) {
  Meshes meshes(asked, solver, options);
  Progress progress;
  Candidate now = meshes.begin(first_meshes(asked, options, refine));
  std::optional<Candidate> best;
  std::string stopped;
  for (int round = 1; now.plan.result.status == SolveStatus::converged; ++round) {
    const Certificate& certificate = now.plan.certificate;
    if (certificate.interval_errors.empty()) break;  // not a valid motion
    now.measure_errors(refine.tolerance);
    if (refine.on_round) {
      refine.on_round({now.intervals(), now.plan.result.iterations, mesh_errors(certificate), now.too_coarse()});
    }
    if (!best || now.is_better_than(*best)) best = now;
    const Mesh next = refined(asked.problem, now.plan.mesh, now.parts);
    const int intervals = next.num_intervals();
    const bool is_enough = refine.ends_when_met ? certificate.passed : intervals > kWorthMerging * now.intervals();
    if (now.meets_tolerance && is_enough) break;
    if (progress.is_over(now)) stopped = fmt::format("no progress in {} rounds", kPatience);
    if (round >= refine.max_rounds) stopped = fmt::format("after {} meshes", round);
    if (intervals > kMostIntervals) stopped = fmt::format("the next mesh would have {} intervals", intervals);
    if (meshes.is_time_over()) stopped = "out of time";
    if (!stopped.empty()) break;
    now = meshes.solve_from(now.plan, next);
    if (refine.ends_when_met && has_failed(now.plan.result.status)) now = meshes.solve_from_task(next);
  }
  const SolveStatus status = now.plan.result.status;  // of the last mesh
  if (status != SolveStatus::converged) {
    stopped = fmt::format("no solution on {} intervals ({})", now.plan.mesh.num_intervals(), to_string(status));
  }
  if (!best) best = std::move(now);
  if (best->intervals() > 0 && !best->meets_tolerance) best->plan.hints.push_back(hint(*best, stopped));
  meshes.enter_books(best->plan);
  return {std::move(best->plan), best->meets_tolerance, status == SolveStatus::interrupted};
}

}  // namespace prowl

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
#include "prowl/repeat.hpp"
#include "prowl/solve_books.hpp"
#include "prowl/transcription/deferred_correction.hpp"

namespace prowl {
namespace {

constexpr int kPatience = 4;  // rounds without progress: some pass before all kinks of a motion are found

/// Tolerance of a solve whose motion will be corrected again. Its errors stay below those of its mesh.
constexpr double kLooseTolerance = 1e-4;
/// A correction that lowers errors by less than this does not converge on these steps.
constexpr double kCorrectionGain = 0.5;

/// Error of an interval, as a multiple of its tolerance, that is split in two.
constexpr double kInTwo = 8.0;

bool is_within(const MeshTolerance& errors, const MeshTolerance& tolerance) {
  return errors.local <= tolerance.local && errors.second <= tolerance.second &&
         errors.reintegration <= tolerance.reintegration;
}

double largest(const std::vector<double>& parts) { return parts.empty() ? 0.0 : *std::ranges::max_element(parts); }

/// A plan with the errors of its intervals as multiples of the tolerance.
struct Candidate {
  Plan plan;
  bool is_exact = false;           ///< solved to the tolerance asked for
  std::vector<double> parts = {};  ///< what shorter steps must lower
  double correctable = 0.0;        ///< largest of what another correction lowers
  bool meets_tolerance = false;    ///< by its certificate

  bool is_judged() const { return !plan.certificate.checks.empty(); }
  bool is_good() const { return meets_tolerance && plan.certificate.passed; }
  double worst() const { return std::max(largest(parts), correctable); }
  int intervals() const { return plan.mesh.num_intervals(); }
  int too_coarse() const {
    return static_cast<int>(std::ranges::count_if(parts, [](double part) { return part > 1.0; }));
  }

  /// A passed certificate comes before a met tolerance: other checks count, too.
  bool is_better_than(const Candidate& other) const {
    const auto rank = [](const Candidate& of) { return std::pair(of.is_good(), of.meets_tolerance); };
    return rank(*this) != rank(other) ? rank(*this) > rank(other) : worst() < other.worst();
  }
};

/// Solves one mesh after the other, each from the motion of the last, and adds up times and iterations.
class Meshes {
 public:
  Meshes(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options)
      : asked_(asked), solver_(solver), options_(options), tolerance_(options.solver.tolerance) {
    options_.coarse_first = false;
  }

  /// Includes certificates, which take seconds on a fine mesh.
  bool is_time_over() const { return seconds_left() <= 0.0; }

  Candidate solve(const Mesh& mesh, bool is_exact) {
    constexpr double kShortestSeconds = 1e-3;  // for the first mesh, with any limit
    PlanOptions options = options_;
    options.solver.max_seconds = std::max(seconds_left(), kShortestSeconds);
    options.solver.tolerance = is_exact ? tolerance_ : std::max(tolerance_, kLooseTolerance);
    std::optional<DiscreteProblem> other;  // asked_ is prepared already
    if (mesh != asked_.mesh) other.emplace(asked_.problem, mesh);
    Plan plan = solve_plan(other ? *other : asked_, solver_, options);
    books_.add(plan);
    return {.plan = std::move(plan), .is_exact = options.solver.tolerance <= tolerance_};
  }
  /// From the motion of another solve, converged or stopped.
  Candidate solve_from(const Plan& plan, const Mesh& mesh, bool is_exact) {
    const bool has_converged = plan.result.status == SolveStatus::converged;
    options_.warm_start = plan.trajectory;
    options_.resume = !has_converged;
    options_.corrected = has_converged;
    options_.warm_start_multipliers.clear();
    if (has_converged && mesh == plan.mesh) options_.warm_start_multipliers = plan.result.stage_multipliers;
    return solve(mesh, is_exact);
  }
  Candidate solve_from_task(const Mesh& mesh, bool is_exact) {
    options_.warm_start = {};
    options_.warm_start_multipliers.clear();
    options_.resume = options_.corrected = false;
    return solve(mesh, is_exact);
  }
  /// The first of these meshes that converges; each starts from the one before, as in make_plan(). A coarse one gets
  /// half of the iterations: where it is the reason for many, a finer one takes fewer.
  Candidate begin(const std::vector<Mesh>& meshes) {
    std::optional<Candidate> first;
    const int most = options_.solver.max_iterations;
    for (const Mesh& level : meshes) {
      options_.solver.max_iterations = &level == &meshes.back() ? most : most / 2;
      const bool goes_on = first && is_worth_going_on_from(first->plan.result.status);
      first = goes_on ? solve_from(first->plan, level, false)
              : first ? solve_from_task(level, false)
                      : solve(level, false);
      if (!has_failed(first->plan.result.status) || !first->plan.reasons.empty()) break;
    }
    options_.solver.max_iterations = most;
    if (has_failed(first->plan.result.status)) return restored(std::move(*first));
    return std::move(*first);
  }
  void judge(Plan& plan) const { prowl::judge(asked_, solver_, options_, plan); }
  /// Replaces times and iterations of one mesh by those of all.
  void enter_books(Plan& plan) const { books_.enter(plan); }

 private:
  /// From a motion of restore(), or as it was.
  Candidate restored(Candidate failed) {
    PlanOptions options = options_;
    options.solver.max_seconds = seconds_left();
    const double before = std::exchange(failed.plan.result.seconds, 0.0);
    const std::optional<Trajectory> motion = restore(asked_, options, failed.plan);
    books_.add_seconds(failed.plan.result.seconds);
    failed.plan.result.seconds += before;
    if (!motion) return failed;
    Plan from;
    from.trajectory = *motion;
    Candidate again = solve_from(from, asked_.mesh, false);
    return has_failed(again.plan.result.status) ? failed : again;
  }
  double seconds_left() const { return options_.solver.max_seconds - (wall_seconds() - begin_); }

  const DiscreteProblem& asked_;
  const NlpSolver& solver_;
  PlanOptions options_;
  double tolerance_;
  double begin_ = wall_seconds();
  SolveBooks books_;
};

/// Estimates errors, decides on the next solve, and knows when to end.
class Refinement {
 public:
  Refinement(const MotionProblem& problem, const RefineOptions& options) : problem_(problem), options_(options) {}

  void estimate(Candidate& now) const {
    const std::vector<StepError> errors = step_errors(problem_, now.plan.trajectory);
    const double tolerance = options_.tolerance.local;
    now.parts.clear();
    now.correctable = 0.0;
    for (const StepError& error : errors) {
      now.parts.push_back(error.lasting / tolerance);
      now.correctable = std::max(now.correctable, error.correctable / tolerance);
    }
    // Where corrections do not converge, only shorter steps help.
    const bool is_stuck =
        now.is_exact && now.plan.mesh == exact_mesh_ && now.correctable > kCorrectionGain * last_correctable_;
    for (std::size_t i = 0; is_stuck && i < errors.size(); ++i)
      now.parts[i] = std::max(now.parts[i], errors[i].correctable / tolerance);
  }

  /// Replaces estimates by the errors of the certificate, and asks for shorter steps where another check fails.
  void read_certificate(Candidate& now) const {
    const Certificate& certificate = now.plan.certificate;
    now.meets_tolerance =
        !certificate.interval_errors.empty() && is_within(mesh_errors(certificate), options_.tolerance);
    if (certificate.interval_errors.empty()) return;  // not a valid motion
    now.parts = error_parts(certificate, options_.tolerance);
    if (!now.meets_tolerance) return;
    for (const CertificateCheck& check : certificate.checks) {
      for (const double time : check.failures) {
        const auto at = std::ranges::lower_bound(certificate.interval_errors, time, {}, &IntervalError::end);
        if (at != certificate.interval_errors.end())
          now.parts[static_cast<std::size_t>(at - certificate.interval_errors.begin())] = kInTwo;
      }
    }
  }

  struct Next {
    Mesh mesh;
    bool is_exact = false;
  };
  /// The next solve: exact once no interval needs splitting.
  Next next(const Candidate& now) {
    const bool is_fine_enough = largest(now.parts) <= 1.0;
    exact_mesh_ = now.is_exact ? now.plan.mesh : Mesh{};
    last_correctable_ = now.correctable;
    return {is_fine_enough ? now.plan.mesh : refined(now.plan.mesh, now.parts), is_fine_enough};
  }

  /// True without a clearly smaller error, or fewer intervals that are too coarse, for some rounds.
  bool is_without_progress(const Candidate& now) {
    constexpr double kClearly = 0.9;
    const bool is_nearer = now.too_coarse() < fewest_ || now.worst() < kClearly * least_;
    fewest_ = std::min(fewest_, now.too_coarse());
    least_ = std::min(least_, now.worst());
    rounds_without_ = is_nearer ? 0 : rounds_without_ + 1;
    return rounds_without_ == kPatience;
  }

 private:
  const MotionProblem& problem_;
  const RefineOptions& options_;
  Mesh exact_mesh_;  ///< of the last solve, if it was exact
  double last_correctable_ = 0.0;
  int fewest_ = std::numeric_limits<int>::max(), rounds_without_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
};

/// Meshes to begin on, until one converges.
std::vector<Mesh> first_meshes(const DiscreteProblem& asked, const PlanOptions& options, const RefineOptions& refine) {
  if (!options.coarse_first || !options.warm_start.empty()) return {asked.mesh};
  if (refine.mesh_is_open) return {asked.mesh, split(asked.mesh, 2), split(asked.mesh, 4)};
  return mesh_levels(asked.problem, asked.mesh);
}

std::string hint(const Candidate& best, const std::string& stopped) {
  const std::vector<IntervalError>& errors = best.plan.certificate.interval_errors;
  if (errors.empty()) return fmt::format("mesh refinement stopped, {}", stopped);
  const auto worst = std::ranges::max_element(best.parts) - best.parts.begin();
  const IntervalError& at = errors[static_cast<std::size_t>(worst)];
  return fmt::format(
      "mesh refinement stopped, {}: errors of {} of {} intervals exceed the tolerance; the worst is {:.3g} times the "
      "tolerance, at {:.3f} s in the {}",
      stopped, best.too_coarse(), best.intervals(), largest(best.parts), at.start, at.where);
}

}  // namespace

RefinedPlan make_refined_plan(const DiscreteProblem& asked, const NlpSolver& solver, const PlanOptions& options,
                              const RefineOptions& refine) {
  if (has_repetitions(asked.problem)) {
    RefinedPlan one = make_refined_plan(first_cycle(asked), solver, options_of_cycle(asked, options), refine);
    repeat(asked, solver, options, one.plan);
    return one;
  }
  Meshes meshes(asked, solver, options);
  Refinement refinement(asked.problem, refine);
  Candidate now = meshes.begin(first_meshes(asked, options, refine));
  std::optional<Candidate> best;
  std::string stopped;
  for (int round = 1; now.plan.result.status == SolveStatus::converged; ++round) {
    refinement.estimate(now);
    if (refine.on_round) {
      refine.on_round(
          {now.intervals(), now.plan.result.iterations, now.worst() * refine.tolerance.local, now.too_coarse()});
    }
    if (now.is_exact && now.worst() <= 1.0) {
      meshes.judge(now.plan);
      refinement.read_certificate(now);
    }
    if (!best || now.is_better_than(*best)) best = now;
    if (now.is_good()) break;
    const auto [mesh, is_exact] = refinement.next(now);
    // Where only other checks fail, each round splits their intervals: errors need not fall.
    if (!now.meets_tolerance && refinement.is_without_progress(now))
      stopped = fmt::format("no progress in {} rounds", kPatience);
    if (round >= refine.max_rounds) stopped = fmt::format("after {} solves", round);
    if (mesh.num_intervals() > kMostIntervals)
      stopped = fmt::format("the next mesh would have {} intervals", mesh.num_intervals());
    if (meshes.is_time_over()) stopped = "out of time";
    if (!stopped.empty()) break;
    now = meshes.solve_from(now.plan, mesh, is_exact);
    if (has_failed(now.plan.result.status)) now = meshes.solve_from_task(mesh, is_exact);
  }
  const SolveStatus status = now.plan.result.status;  // of the last solve
  if (status != SolveStatus::converged) {
    stopped = fmt::format("no solution on {} intervals ({})", now.intervals(), to_string(status));
  }
  if (!best) best = std::move(now);
  if (!best->is_judged()) {
    meshes.judge(best->plan);
    refinement.read_certificate(*best);
  }
  if (best->plan.result.status == SolveStatus::converged && !best->meets_tolerance)
    best->plan.hints.push_back(hint(*best, stopped));
  meshes.enter_books(best->plan);
  return {std::move(best->plan), best->meets_tolerance, status == SolveStatus::interrupted};
}

}  // namespace prowl

#include "prowl/elastic/elastic_solve.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "prowl/guess/initial_guess.hpp"
#include "prowl/nlp/elastic_nlp.hpp"
#include "prowl/transcription/motion_limits.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

constexpr double kTolerance = 1e-5;  // relative to a weight or a limit
constexpr int kIterations = 500;
constexpr double kSeen = 1e-3;  // of a limit's size: less is within the tolerance of the solve

/// Weight of the task's own cost, which is about 1 at a solution (docs/task-file.md): too small to pay for a visible
/// breach, large enough to keep the motion smooth. Without it the optimiser finds motions that only a coarse mesh
/// allows.
constexpr double kOwnCost = 1e-3;

/// The node's share of the motion's time; 1 for a limit at one moment.
double share(const MotionLimit& limit, const DiscreteProblem& discrete) {
  if (limit.is_moment || limit.kind == LimitKind::goal || limit.kind == LimitKind::foothold) return 1.0;
  const MeshNode& node = discrete.nodes[limit.node];
  return 0.5 * (node.h_in + node.h_out) / discrete.nodes.back().time;
}

std::vector<Breach> read(const std::vector<MotionLimit>& limits, const std::vector<SoftBound>& soft,
                         const Eigen::VectorXd& violations, const Trajectory& motion) {
  std::map<std::tuple<LimitKind, int, std::string>, Breach> breaches;
  for (std::size_t i = 0; i < limits.size(); ++i) {
    const MotionLimit& limit = limits[i];
    const double amount = std::abs(violations(static_cast<Eigen::Index>(i))) * limit.si;
    if (amount < kSeen * limit.size) continue;
    Breach& breach = breaches[{limit.kind, limit.phase, limit.subject}];
    breach.total += soft[i].price * amount / limit.size;
    if (amount <= breach.amount) continue;
    const double total = breach.total;
    breach = {limit.kind, limit.phase, motion.nodes[limit.node].time, limit.subject,
              amount,     limit.unit,  amount / limit.size,           total};
  }
  std::vector<Breach> result;
  for (auto& [key, breach] : breaches) result.push_back(std::move(breach));
  std::ranges::stable_sort(result, std::greater(), &Breach::total);
  return result;
}

}  // namespace

ElasticResult elastic_solve(const DiscreteProblem& discrete, const NlpSolver& solver, SolverOptions options,
                            const std::function<bool(const MotionLimit&)>& gives_way) {
  options.tolerance = std::max(options.tolerance, kTolerance);
  options.max_iterations = kIterations;
  const Trajectory guess = initial_guess(discrete);
  Transcription hard(discrete, guess);
  std::vector<MotionLimit> limits;
  std::vector<SoftBound> soft;
  for (MotionLimit& limit : motion_limits(hard.nodes())) {
    if (!gives_way(limit)) continue;
    soft.push_back({limit.is_row, limit.index, limit.size / limit.si, std::max(share(limit, discrete), 1e-3)});
    limits.push_back(std::move(limit));
  }
  const Eigen::VectorXd z_guess = hard.pack(guess);
  ElasticNlp elastic(hard, soft, kOwnCost);
  const SolveResult solved = solver.solve(elastic, elastic.with_slacks(z_guess), options);
  Trajectory motion = hard.unpack(elastic.inner(solved.z));
  std::vector<Breach> breaches = read(limits, soft, elastic.violations(solved.z), motion);
  return {solved.status, std::move(breaches), std::move(motion)};
}

ElasticResult elastic_solve(const DiscreteProblem& discrete, const NlpSolver& solver, SolverOptions options) {
  return elastic_solve(discrete, solver, std::move(options), [](const MotionLimit&) { return true; });
}

}  // namespace prowl

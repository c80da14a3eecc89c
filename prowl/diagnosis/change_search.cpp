#include "prowl/diagnosis/change_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <utility>

#include "prowl/certificate/certificate.hpp"
#include "prowl/error.hpp"
#include "prowl/feasibility/feasibility.hpp"
#include "prowl/guess/initial_guess.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

constexpr double kFirst = 0.4;       // first amount: a factor of 1.5
constexpr double kFurther = 2.5;     // ratio of successive amounts
constexpr double kPrecision = 0.05;  // a bisection ends at 5 % of the number, or 10 % of a large amount
constexpr double kNoMatch = 2.0;     // larger multiples of the smallest amount are dropped
/// On about 20 intervals, 21 shipped tasks drift by at most 0.6 mm, a jump by 4 mm, and those that need a finer mesh
/// (three trots, a walk) by at least 25 mm.
constexpr double kMostDrift = 5.0 * CertificateLimits::contact_drift;
constexpr int kMostIterations = 200;  // on a coarse mesh, where a solution takes 10 to 80, of jumps up to 160

/// Stops a solve without progress: most problems of a search have no solution.
class StallWatch {
 public:
  explicit StallWatch(SolverOptions& options) : interrupt_(options.interrupt), other_(std::move(options.on_iteration)) {
    options.interrupt = &stop_;
    options.on_iteration = [this](const SolveProgress& progress) { look(progress); };
  }
  StallWatch(const StallWatch&) = delete;
  StallWatch& operator=(const StallWatch&) = delete;

 private:
  void look(const SolveProgress& progress) {
    if (other_) other_(progress);
    constexpr int kPatience = 30;     // iterations in which the violation has to halve
    constexpr double kNearly = 1e-4;  // a violation below this is about to vanish
    if (progress.constraint_violation < 0.5 * best_) {
      best_ = progress.constraint_violation;
      since_ = progress.iteration;
    }
    const bool stalls = best_ > kNearly && progress.iteration - since_ > kPatience;
    if (stalls || (interrupt_ && interrupt_->load())) stop_ = true;
  }

  const std::atomic<bool>* interrupt_;
  std::function<void(const SolveProgress&)> other_;  ///< the caller's callback
  std::atomic<bool> stop_ = false;
  double best_ = std::numeric_limits<double>::infinity();
  int since_ = 0;
};

}  // namespace

ChangeSearch ChangeSearch::within(double part) const {
  return {solver_, options_, part * std::max(seconds_left(), 0.0)};
}

double ChangeSearch::seconds_of_solve(double part, double most) const {
  constexpr double kLeast = 1e-3;
  return std::max(std::min(most, part * seconds_left()), kLeast);
}

std::optional<Trajectory> ChangeSearch::motion(const DiscreteProblem& discrete) const {
  if (!may_go_on()) return {};
  try {
    if (!proofs_of_infeasibility(discrete.problem, discrete.schedule).empty()) return {};
    const Trajectory guess = initial_guess(discrete);
    Transcription nlp(discrete, guess);
    SolverOptions options = options_;
    options.max_iterations = kMostIterations;
    options.max_seconds = seconds_of_solve();
    StallWatch watch(options);
    const SolveResult result = solver_.solve(nlp, nlp.pack(guess), options);
    if (result.status != SolveStatus::converged) return {};
    return nlp.unpack(result.z);
  } catch (const Error&) {  // contradictory bounds, a model that cannot be evaluated: no plan
    return {};
  }
}

bool ChangeSearch::solves(const DiscreteProblem& discrete) const {
  const std::optional<Trajectory> found = motion(discrete);
  if (!found) return false;
  const Certificate certificate = certify(discrete, *found);
  const CertificateCheck* const drift = certificate.find("contact drift");
  return !drift || drift->worst <= kMostDrift;
}

bool ChangeSearch::solves(const AdjustableParameter& parameter, double amount, const Mesh& mesh) const {
  try {
    return solves(DiscreteProblem(parameter.problem(amount), mesh));
  } catch (const Error&) {
    return false;
  }
}

double ChangeSearch::bisected(const AdjustableParameter& parameter, double too_little, double enough,
                              const Mesh& mesh) const {
  while (enough - too_little > std::max(kPrecision, 0.1 * enough) && may_go_on()) {
    const double middle = printable_amount(parameter, 0.5 * (too_little + enough));
    if (middle >= enough) break;  // no printable number in between
    (solves(parameter, middle, mesh) ? enough : too_little) = middle;
  }
  return enough;
}

ChangesFound ChangeSearch::smallest(const std::vector<AdjustableParameter>& parameters, const Mesh& mesh,
                                    const std::function<void(const std::string&)>& on_step) const {
  ChangesFound result;
  std::vector<FoundChange>& found = result.found;
  std::vector<bool> done(parameters.size(), false);
  double enough = std::numeric_limits<double>::infinity();  // weighted amount of the smallest change
  double before = 0.0;
  int tries = 0;
  for (double turned = kFirst; before < kNoMatch * enough; turned *= kFurther) {
    bool any_left = false;
    int about = tries;  // up to the end of this round; another may follow
    for (std::size_t i = 0; i < parameters.size(); ++i)
      about += !done[i] && before / parameters[i].weight < parameters[i].most;
    for (std::size_t i = 0; i < parameters.size(); ++i) {
      const AdjustableParameter& parameter = parameters[i];
      const double too_little = before / parameter.weight,
                   amount = printable_amount(parameter, std::min(turned / parameter.weight, parameter.most));
      if (done[i] || too_little >= parameter.most) continue;
      if (!may_go_on()) break;
      any_left = true;
      ++tries;
      if (on_step) on_step(fmt::format("{} ({} of about {})", in_words(parameter, amount), tries, about));
      if (before == 0.0) ++result.tried;
      if (!solves(parameter, amount, mesh)) continue;
      done[i] = true;
      found.push_back({parameter, bisected(parameter, too_little, amount, mesh)});
      enough = std::min(enough, found.back().weighted());
    }
    if (!any_left || !may_go_on()) break;
    before = turned;
  }
  result.out_of_time = seconds_left() <= 0.0;
  std::erase_if(found, [&](const FoundChange& one) { return one.weighted() > kNoMatch * enough; });
  std::ranges::stable_sort(found, std::less(), &FoundChange::weighted);
  // Amounts within the precision of a bisection are equal; a limit then comes before a demand of the task.
  const auto first = std::ranges::find_if(found, [](const FoundChange& one) { return !one.parameter.is_asked; });
  if (first != found.end() && first->weighted() <= found.front().weighted() + kPrecision) {
    std::rotate(found.begin(), first, first + 1);
  }
  return result;
}

}  // namespace prowl

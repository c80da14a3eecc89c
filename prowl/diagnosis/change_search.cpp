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

constexpr double kFirst = 0.4;       // amount: half as much again
constexpr double kFurther = 2.5;     // from one amount to the next
constexpr double kPrecision = 0.05;  // where a bisection ends: 5 % of the number, and 10 % of a large amount
constexpr double kNoMatch = 2.0;     // a change is told of besides a smaller one up to so many times its amount
/// Of the shipped tasks on about 20 intervals 21 drift by 0.6 mm or less, a jump by 4 mm, and those that only a finer
/// mesh solves (three trots, a walk) by 25 mm and more.
constexpr double kMostDrift = 5.0 * CertificateLimits::contact_drift;
constexpr int kMostIterations = 200;  // on a coarse mesh; what has a solution takes 10 to 80, jumps up to 160

/// Stops a solve that gets nowhere: without a solution there is none to find, and that is what most solves of a search
/// are.
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
  std::function<void(const SolveProgress&)> other_;  ///< that was to be told already
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
  } catch (const Error&) {  // bounds that contradict each other, a model that cannot be evaluated: no plan either
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

bool ChangeSearch::solves(const Knob& knob, double amount, const Mesh& mesh) const {
  try {
    return solves(DiscreteProblem(knob.problem(amount), mesh));
  } catch (const Error&) {
    return false;
  }
}

double ChangeSearch::bisected(const Knob& knob, double too_little, double enough, const Mesh& mesh) const {
  while (enough - too_little > std::max(kPrecision, 0.1 * enough) && may_go_on()) {
    const double middle = printable_amount(knob, 0.5 * (too_little + enough));
    if (middle >= enough) break;  // as it is told, there is no number between
    (solves(knob, middle, mesh) ? enough : too_little) = middle;
  }
  return enough;
}

ChangesFound ChangeSearch::smallest(const std::vector<Knob>& knobs, const Mesh& mesh,
                                    const std::function<void(const std::string&)>& on_step) const {
  ChangesFound result;
  std::vector<FoundChange>& found = result.found;
  std::vector<bool> done(knobs.size(), false);
  double enough = std::numeric_limits<double>::infinity();  // of the smallest found, weighted
  double before = 0.0;
  int tries = 0;
  for (double turned = kFirst; before < kNoMatch * enough; turned *= kFurther) {
    bool any_left = false;
    int about = tries;  // with those of this round; whether there is a next one is not known
    for (std::size_t i = 0; i < knobs.size(); ++i) about += !done[i] && before / knobs[i].weight < knobs[i].most;
    for (std::size_t i = 0; i < knobs.size(); ++i) {
      const Knob& knob = knobs[i];
      const double too_little = before / knob.weight,
                   amount = printable_amount(knob, std::min(turned / knob.weight, knob.most));
      if (done[i] || too_little >= knob.most) continue;
      if (!may_go_on()) break;
      any_left = true;
      ++tries;
      if (on_step) on_step(fmt::format("{} ({} of about {})", in_words(knob, amount), tries, about));
      if (before == 0.0) ++result.tried;
      if (!solves(knob, amount, mesh)) continue;
      done[i] = true;
      found.push_back({knob, bisected(knob, too_little, amount, mesh)});
      enough = std::min(enough, found.back().weighted());
    }
    if (!any_left || !may_go_on()) break;
    before = turned;
  }
  result.out_of_time = seconds_left() <= 0.0;
  std::erase_if(found, [&](const FoundChange& one) { return one.weighted() > kNoMatch * enough; });
  std::ranges::stable_sort(found, std::less(), &FoundChange::weighted);
  // What differs by less than bisections tell is equal, and a limit comes before what the task asks.
  const auto first = std::ranges::find_if(found, [](const FoundChange& one) { return !one.knob.is_asked; });
  if (first != found.end() && first->weighted() <= found.front().weighted() + kPrecision) {
    std::rotate(found.begin(), first, first + 1);
  }
  return result;
}

}  // namespace prowl

#include "prowl/simulation/sweep.hpp"

#include <algorithm>
#include <boost/math/distributions/binomial.hpp>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <future>
#include <limits>
#include <mutex>
#include <numbers>
#include <optional>
#include <random>
#include <thread>

#include "prowl/model/body_tree.hpp"

namespace prowl {
namespace {

using Uniform = boost::random::uniform_real_distribution<double>;

/// Smallest number of contacts in stance between `from` and `to`.
long fewest_contacts(const Tracker& tracker, double from, double to) {
  long fewest = std::numeric_limits<long>::max();
  for (const TrackingPlan::Segment& segment : tracker.plan().segments) {
    if (segment.end < from || segment.start > to) continue;
    fewest = std::min(fewest, std::ranges::count(segment.in_contact, true));
  }
  return fewest;
}

/// A push in a random horizontal direction, at a random time of the motion.
Push draw_push(const Tracker& tracker, double impulse, double on_two_feet, double duration, std::mt19937_64& random) {
  const double angle = Uniform(0.0, 2.0 * std::numbers::pi)(random);
  const double time = Uniform(tracker.start(), tracker.end())(random);
  const double size = fewest_contacts(tracker, time, time + duration) <= 2 ? on_two_feet : impulse;
  return {size * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0), time, duration};
}

/// A perturbation of one kind, of any size.
struct Kind {
  static constexpr int kHalvings = 3;
  const char* name;
  const char* unit;
  double first, most;  ///< sizes tried: first, doubled up to most
  std::function<void(SimulationOptions&, double, std::mt19937_64&)> apply;

  /// Upper bound on the number of sizes tried.
  int most_sizes() const {
    int sizes = kHalvings;
    for (double size = first; size <= most; size *= 2.0) ++sizes;
    return sizes;
  }
};

/// Kinds of perturbation.
std::vector<Kind> kinds_of_perturbation(const Tracker& tracker) {
  return {
      {"masses larger by", "%", 10.0, 320.0, [](auto& o, double x, auto&) { o.physics.mass_scale = 1.0 + 0.01 * x; }},
      {"masses smaller by", "%", 10.0, 80.0, [](auto& o, double x, auto&) { o.physics.mass_scale = 1.0 - 0.01 * x; }},
      {"friction lower by", "%", 10.0, 80.0,
       [](auto& o, double x, auto&) { o.physics.friction_scale = 1.0 - 0.01 * x; }},
      {"push of", "N s", 5.0, 160.0,
       [&tracker](auto& o, double x, auto& random) {
         o.pushes = {draw_push(tracker, x, x, PerturbationRanges{}.push_duration, random)};
       }},
      {"sensor noise times", "", 2.0, 64.0, [](auto& o, double x, auto&) { o.noise_scale = x; }},
      {"unknown delay of", "ms", 1.0, 32.0, [](auto& o, double x, auto&) { o.unknown_delay = 1e-3 * x; }},
  };
}

}  // namespace

StartError draw_start_error(const RobotModel& robot, double share, std::mt19937_64& random,
                            const PerturbationRanges& ranges) {
  const double height = height_share(robot);
  StartError error;
  const auto fill = [&](auto part, double range) {
    for (double& value : part) value = range == 0.0 ? 0.0 : Uniform(-range, range)(random);
  };
  fill(error.base.head<3>(), share * height * ranges.base_position);
  fill(error.base.tail<3>(), share * ranges.base_angle);
  fill(error.twist.head<3>(), share * std::sqrt(height) * ranges.base_velocity);
  fill(error.twist.tail<3>(), share * ranges.base_rate);
  error.joints.resize(robot.nu());
  fill(error.joints.head(robot.nu()), share * ranges.joint);
  return error;
}

SimulationOptions perturbed(const MotionProblem& problem, const Tracker& tracker, const SimulationOptions& options,
                            const PerturbationRanges& ranges, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto draw = [&](double low, double high) { return low < high ? Uniform(low, high)(random) : low; };
  const RobotModel& robot = problem.robot;
  const double height = height_share(robot);
  SimulationOptions result = options;
  result.seed = random();  // a different random sequence for the sensors
  result.start = draw_start_error(robot, 1.0, random, ranges);
  PhysicsOptions& physics = result.physics;
  physics.body_scales.clear();
  for (int b = 0; b <= robot.nu(); ++b) physics.body_scales.push_back(draw(1.0 - ranges.mass, 1.0 + ranges.mass));
  const double center = height * ranges.base_center;
  for (double& value : physics.base_center) value = draw(-center, center);
  physics.friction_scale = draw(ranges.friction_low, ranges.friction_high);
  result.bandwidth = draw(ranges.bandwidth_low, ranges.bandwidth_high);
  result.unknown_delay = draw(ranges.delay_low, ranges.delay_high) - options.delay;
  result.ground.height = draw(-height * ranges.ground_height, height * ranges.ground_height);
  for (double& value : result.ground.tilt) value = draw(-ranges.ground_tilt, ranges.ground_tilt);
  result.unknown_noise = draw(ranges.noise_low, ranges.noise_high);
  const double impulse = ranges.push.value_or(std::sqrt(height) * ranges.push_velocity * robot.mass());
  result.pushes = {
      draw_push(tracker, impulse, ranges.push_on_two_feet.value_or(impulse), ranges.push_duration, random)};
  return result;
}

double mass_factor(const RobotModel& robot, const PhysicsOptions& physics) {
  const BodyTree tree = body_tree(robot);
  double mass = 0.0;
  for (std::size_t b = 0; b < tree.bodies.size(); ++b)
    mass += tree.bodies[b].mass * (physics.body_scales.empty() ? 1.0 : physics.body_scales[b]);
  return physics.mass_scale * mass / robot.mass();
}

std::string pushed_phase(const Tracker& tracker, const SimulationOptions& options) {
  if (options.pushes.empty()) return "";
  return tracker.segment(options.pushes.front().time + 0.5 * options.pushes.front().duration).name;
}

std::vector<SweepCase> run_cases(const MotionProblem& problem, const Tracker& tracker, const SuccessCriteria& criteria,
                                 const std::vector<SimulationOptions>& options, const SweepProgress& on_done,
                                 const std::atomic<bool>* interrupt) {
  std::vector<std::optional<SweepCase>> cases(options.size());
  std::atomic<std::size_t> next = 0;
  std::mutex report;
  int done = 0;
  const auto tell = [&] {
    if (on_done) on_done(done, static_cast<int>(options.size()));
  };
  tell();
  const auto work = [&] {
    while (!(interrupt && *interrupt)) {  // checked before taking a case: finished cases have no gaps
      const std::size_t i = next++;
      if (i >= options.size()) return;
      cases[i] = SweepCase{options[i], simulate(problem, tracker, criteria, options[i])};
      const std::lock_guard lock(report);
      ++done;
      tell();
    }
  };
  std::vector<std::future<void>> workers;
  for (unsigned i = 0; i < std::max(1u, std::thread::hardware_concurrency()); ++i) {
    workers.push_back(std::async(std::launch::async, work));
  }
  for (std::future<void>& worker : workers) worker.get();
  std::vector<SweepCase> finished;
  for (std::optional<SweepCase>& one : cases) {
    if (!one) break;
    finished.push_back(std::move(*one));
  }
  return finished;
}

SuccessRate success_rate(int successes, int cases) {
  SuccessRate rate{successes, cases};
  if (cases == 0) return rate;
  using Binomial = boost::math::binomial_distribution<double>;
  constexpr double kTail = 0.025;
  rate.lower = Binomial::find_lower_bound_on_p(cases, successes, kTail);
  rate.upper = Binomial::find_upper_bound_on_p(cases, successes, kTail);
  return rate;
}

std::vector<Breakdown> find_breakdowns(const MotionProblem& problem, const Tracker& tracker,
                                       const SuccessCriteria& criteria, const SimulationOptions& options,
                                       std::uint64_t seed, int cases, const SweepProgress& on_done,
                                       const std::atomic<bool>* interrupt) {
  const std::vector<Kind> kinds = kinds_of_perturbation(tracker);
  int most = 0, done = 0;
  for (const Kind& kind : kinds) most += cases * kind.most_sizes();
  const auto interrupted = [&] { return interrupt && *interrupt; };
  const auto survives = [&](const Kind& kind, double size) {
    std::vector<SimulationOptions> all(static_cast<std::size_t>(cases), options);
    for (std::size_t i = 0; i < all.size(); ++i) {
      std::mt19937_64 random(seed + i);
      all[i].seed = random();
      kind.apply(all[i], size, random);
    }
    const int before = done;
    const auto count = [&](int now, int) {
      done = before + now;
      if (on_done) on_done(done, most);
    };
    const auto finished = run_cases(problem, tracker, criteria, all, count, interrupt);
    return 2 * std::ranges::count_if(finished, [](const SweepCase& one) { return one.result.success(); }) >=
           std::ssize(finished);
  };

  std::vector<Breakdown> breakdowns;
  int counted = 0;
  for (const Kind& kind : kinds) {
    Breakdown found{kind.name, kind.unit, 0.0, std::numeric_limits<double>::infinity()};
    for (double size = kind.first; size <= kind.most && !interrupted(); size *= 2.0) {
      if (!survives(kind, size)) {
        found.fails = size;
        break;
      }
      found.holds = size;
    }
    for (int i = 0; i < Kind::kHalvings && std::isfinite(found.fails) && !interrupted(); ++i) {
      const double middle = 0.5 * (found.holds + found.fails);
      (survives(kind, middle) ? found.holds : found.fails) = middle;
    }
    if (interrupted()) break;
    breakdowns.push_back(found);
    done = counted += cases * kind.most_sizes();
    if (on_done) on_done(done, most);
  }
  return breakdowns;
}

}  // namespace prowl

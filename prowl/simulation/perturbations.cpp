#include "prowl/simulation/perturbations.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <boost/random/uniform_real_distribution.hpp>
#include <cmath>
#include <limits>
#include <numbers>

#include "prowl/error.hpp"
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

struct DrawnKind {
  const char* name;
  void (*leave_out)(PerturbationRanges& ranges);
};
constexpr std::array kKinds{
    DrawnKind{
        "start",
        [](PerturbationRanges& r) { r.base_position = r.base_angle = r.base_velocity = r.base_rate = r.joint = 0.0; }},
    DrawnKind{"mass", [](PerturbationRanges& r) { r.mass = 0.0; }},
    DrawnKind{"center", [](PerturbationRanges& r) { r.base_center = 0.0; }},
    DrawnKind{"friction", [](PerturbationRanges& r) { r.friction_low = r.friction_high = 1.0; }},
    DrawnKind{"bandwidth", [](PerturbationRanges& r) { r.bandwidth_low = r.bandwidth_high = 0.0; }},
    DrawnKind{"delay", [](PerturbationRanges& r) { r.delay_low = r.delay_high = SimulationOptions{}.delay; }},
    DrawnKind{"ground", [](PerturbationRanges& r) { r.ground_height = r.ground_tilt = 0.0; }},
    DrawnKind{"noise", [](PerturbationRanges& r) { r.noise_low = r.noise_high = 1.0; }},
    DrawnKind{"push", [](PerturbationRanges& r) { r.push = r.push_on_two_feet = 0.0; }}};

}  // namespace

std::vector<std::string> perturbation_kinds() {
  std::vector<std::string> names;
  for (const DrawnKind& kind : kKinds) names.emplace_back(kind.name);
  return names;
}

PerturbationRanges only(const std::vector<std::string>& kinds, PerturbationRanges ranges) {
  const std::vector<std::string> known = perturbation_kinds();
  for (const std::string& name : kinds) {
    if (std::ranges::count(known, name) == 0)
      throw InputError(fmt::format("only: '{}' is not allowed; need one of {}", name, fmt::join(known, ", ")));
  }
  for (const DrawnKind& kind : kKinds)
    if (!kinds.empty() && std::ranges::count(kinds, kind.name) == 0) kind.leave_out(ranges);
  return ranges;
}

double draw_between(double low, double high, std::mt19937_64& random) {
  const bool is_range = low < high;
  const double drawn = (is_range ? Uniform(low, high) : Uniform(0.0, 1.0))(random);
  return is_range ? drawn : low;
}

Eigen::Vector3d draw_direction(std::mt19937_64& random) {
  const double angle = Uniform(0.0, 2.0 * std::numbers::pi)(random);
  return {std::cos(angle), std::sin(angle), 0.0};
}

Push draw_push(const Tracker& tracker, double impulse, double on_two_feet, double duration, std::mt19937_64& random) {
  const Eigen::Vector3d direction = draw_direction(random);
  const double time = Uniform(tracker.start(), tracker.end())(random);
  const double size = fewest_contacts(tracker, time, time + duration) <= 2 ? on_two_feet : impulse;
  return {size * direction, time, duration};
}

StartError draw_start_error(const RobotModel& robot, double share, std::mt19937_64& random,
                            const PerturbationRanges& ranges) {
  const double height = height_share(robot);
  StartError error;
  const auto fill = [&](auto part, double range) {
    for (double& value : part) value = draw_between(-range, range, random);
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
  const auto draw = [&](double low, double high) { return draw_between(low, high, random); };
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
  const Push push =
      draw_push(tracker, impulse, ranges.push_on_two_feet.value_or(impulse), ranges.push_duration, random);
  result.pushes.clear();
  if (!push.impulse.isZero(0.0)) result.pushes.push_back(push);
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

}  // namespace prowl

#include "prowl/mpc/stepping_patterns.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "prowl/error.hpp"
#include "prowl/motion/gait.hpp"

namespace prowl {
namespace {

/// A gait online: strides in units of sqrt(height / gravity). Shorter than those of planned gaits: a robot that is
/// pushed must soon put a foot elsewhere.
struct OnlineGait {
  const char* name;
  double stride, duty_factor;
};
constexpr OnlineGait kGaits[] = {{"trot", 2.2, 0.6}, {"walk", 4.0, 0.77}, {"pace", 2.2, 0.6}};
/// With 2.6, Talos falls in one of six runs in which it steps for 20 s; with 2.9 in none.
constexpr OnlineGait kBipedWalk = {"walk", 2.9, 0.6};

}  // namespace

const std::vector<std::string>& stepping_gaits() {
  static const std::vector<std::string> names = {"stand", "trot", "walk", "pace"};
  return names;
}

SteppingPattern stepping_pattern(const RobotModel& robot, const std::vector<std::vector<int>>& feet, double height,
                                 const std::string& gait) {
  if (std::ranges::find(stepping_gaits(), gait) == stepping_gaits().end())
    throw InputError(fmt::format("gait: '{}' is not allowed; need one of {}", gait, fmt::join(stepping_gaits(), ", ")));
  SteppingPattern pattern;
  if (gait == "stand") return pattern;
  const double time = std::sqrt(height / RobotModel::kGravity);
  if (feet.size() == 2 && gait == "walk") {
    pattern.groups = {{0}, {1}};
    pattern.stride = kBipedWalk.stride * time;
    pattern.duty_factor = kBipedWalk.duty_factor;
    return pattern;
  }
  const std::optional<Feet> corners = feet.size() == 4 ? find_feet(robot) : std::nullopt;
  if (!corners)
    throw InputError(fmt::format(
        "gait: {} cannot {}; need {}", robot.name(), gait,
        feet.size() == 2 ? "walk or stand on two feet" : "a robot with one foot at each corner of its base"));
  for (const std::vector<Foot>& swings : gait_pattern(gait).swings) {
    std::vector<int>& group = pattern.groups.emplace_back();
    for (const Foot corner : swings) {
      const int contact = (*corners)[static_cast<std::size_t>(corner)];
      const auto has_it = [contact](const std::vector<int>& foot) { return foot.front() == contact; };
      group.push_back(static_cast<int>(std::ranges::find_if(feet, has_it) - feet.begin()));
    }
  }
  const OnlineGait& online = *std::ranges::find_if(kGaits, [&](const OnlineGait& one) { return one.name == gait; });
  pattern.stride = online.stride * time;
  pattern.duty_factor = online.duty_factor;
  return pattern;
}

}  // namespace prowl

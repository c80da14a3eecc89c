#include "prowl/online/random_events.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prowl/simulation/perturbations.hpp"
#include "prowl/text/option_check.hpp"

namespace prowl {
namespace {

constexpr double kKickEvery = 2.0, kAfterKick = 1.9;                            // [s]
constexpr double kCommandFor = 1.0, kCommandSpread = 3.0, kAfterCommand = 3.0;  // [s]
/// Kicks and commands of one seed have nothing in common.
constexpr std::uint64_t kKickStream = 1, kCommandStream = 2;

std::mt19937_64 stream_of(const OnlineOptions& options, std::uint64_t stream) {
  return std::mt19937_64(options.simulation.seed * 4 + stream);
}

}  // namespace

void add_kicks(const RobotModel& robot, double speed, OnlineOptions& options) {
  check_option(speed > 0.0 && std::isfinite(speed), "kicks", speed, "a finite number > 0 m/s");
  check_option(options.duration > kKickEvery + kAfterKick, "duration", options.duration,
               fmt::format("more than {:g} s: the first kick comes after {:g} s, and none in the last {:g} s",
                           kKickEvery + kAfterKick, kKickEvery, kAfterKick));
  std::mt19937_64 random = stream_of(options, kKickStream);
  for (double t = kKickEvery; t < options.duration - kAfterKick; t += kKickEvery) {
    options.simulation.pushes.push_back({speed * robot.mass() * draw_direction(random), t});
  }
}

void add_one_kick(const RobotModel& robot, double speed, OnlineOptions& options) {
  std::mt19937_64 random = stream_of(options, kKickStream);
  const Eigen::Vector3d impulse = speed * robot.mass() * draw_direction(random);
  options.simulation.pushes.push_back({impulse, kKickEvery * draw_between(1.0, 2.0, random)});
}

void add_random_commands(double most, OnlineOptions& options) {
  check_option(most > 0.0 && std::isfinite(most), "random commands", most, "a finite number > 0");
  std::mt19937_64 random = stream_of(options, kCommandStream);
  for (double t = kFirstCommand; t < options.duration - kAfterCommand;
       t += kCommandFor + kCommandSpread * draw_between(0.0, 1.0, random)) {
    TimedCommand timed{.time = t, .command = {}};
    for (double* part : {&timed.command.forward, &timed.command.left, &timed.command.turn})
      *part = draw_between(-most, most, random);
    options.commands.push_back(timed);
  }
}

}  // namespace prowl

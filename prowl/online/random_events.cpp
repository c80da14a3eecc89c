#include "prowl/online/random_events.hpp"

#include <cmath>
#include <numbers>
#include <random>

namespace prowl {
namespace {

constexpr double kKickEvery = 2.0, kAfterKick = 1.9;                                                 // [s]
constexpr double kFirstCommand = 1.0, kCommandFor = 1.0, kCommandSpread = 3.0, kAfterCommand = 3.0;  // [s]
/// Kicks and commands of one seed have nothing in common.
constexpr std::uint64_t kKickStream = 1, kCommandStream = 2;

/// The same numbers on all platforms, which std::uniform_real_distribution does not promise.
class Evenly {
 public:
  Evenly(std::uint64_t seed, std::uint64_t stream) : random_(seed * 4 + stream) {}
  double operator()(double lower, double upper) {
    return lower + (upper - lower) * static_cast<double>(random_()) * 0x1p-64;
  }

 private:
  std::mt19937_64 random_;
};

}  // namespace

void add_kicks(const RobotModel& robot, double speed, OnlineOptions& options) {
  Evenly random(options.simulation.seed, kKickStream);
  for (double t = kKickEvery; t < options.duration - kAfterKick; t += kKickEvery) {
    const double angle = random(0.0, 2.0 * std::numbers::pi), impulse = speed * robot.mass();
    options.simulation.pushes.push_back({{impulse * std::cos(angle), impulse * std::sin(angle), 0.0}, t});
  }
}

void add_random_commands(double most, OnlineOptions& options) {
  Evenly random(options.simulation.seed, kCommandStream);
  for (double t = kFirstCommand; t < options.duration - kAfterCommand;
       t += kCommandFor + kCommandSpread * random(0.0, 1.0)) {
    TimedCommand timed{.time = t, .command = {}};
    for (double* part : {&timed.command.forward, &timed.command.left, &timed.command.turn}) *part = random(-most, most);
    options.commands.push_back(timed);
  }
}

}  // namespace prowl

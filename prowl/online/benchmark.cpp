#include "prowl/online/benchmark.hpp"

#include <fmt/format.h>

#include <numbers>

#include "prowl/model/body_tree.hpp"
#include "prowl/mpc/stepping_patterns.hpp"
#include "prowl/online/pendulum_bound.hpp"
#include "prowl/online/random_events.hpp"

namespace prowl {
namespace {

using Events = BenchmarkRow::Events;

constexpr double kCommands = 0.5;  ///< largest random velocities [m/s] and turn rates [rad/s]
constexpr double kOneKick = 6.0, kShort = 20.0, kLong = 60.0, kTicks = 1000.0, kHour = 3600.0;  // [s]
constexpr int kCurveSeeds = 10, kFewSeeds = 50, kManySeeds = 200;
constexpr double kPayload = 0.2;  ///< of the robot's mass
constexpr double kSlippery = 0.4;
constexpr double kSlope = 10.0;                         // [degrees]
constexpr double kCurve[] = {0.2, 0.4, 0.6, 0.8, 1.2};  ///< kicks [m/s]; kicks_1.0 is of the curve, too

class Rows {
 public:
  Rows(const RobotModel& robot, const OnlineOptions& base) : base_(base) {
    const auto feet = contacts_of_feet(robot);
    const double height = standing_on_ground(robot).z();
    bound_ = pendulum_bound(robot, feet, height, stepping_pattern(robot, feet, height, "trot"));
  }

  BenchmarkRow& add(const std::string& name, const std::string& meaning, double duration, int seeds, Events events) {
    BenchmarkRow& row = rows_.emplace_back();
    row.name = name;
    row.meaning = meaning;
    row.seeds = seeds;
    row.events = events;
    row.options = base_;
    row.options.duration = duration;
    row.options.gait = "trot";
    return row;
  }
  void add_kicks(const std::string& name, double kick, double duration, int seeds, Events events) {
    const char* const when = events == Events::one_kick ? "once" : "every 2 s";
    BenchmarkRow& row = add(name, fmt::format("kicks of {:.1f} m/s {}", kick, when), duration, seeds, events);
    row.kick = kick;
    row.pendulum = bound_;
  }
  std::vector<BenchmarkRow> take() { return std::move(rows_); }

 private:
  const OnlineOptions& base_;
  double bound_ = 0.0;
  std::vector<BenchmarkRow> rows_;
};

}  // namespace

OnlineOptions BenchmarkRow::run(const RobotModel& robot, std::uint64_t seed) const {
  OnlineOptions one = options;
  one.simulation.seed = seed;
  switch (events) {
    case Events::none: break;
    case Events::commands: add_random_commands(kCommands, one); break;
    case Events::kicks: add_kicks(robot, kick, one); break;
    case Events::one_kick: add_one_kick(robot, kick, one); break;
  }
  return one;
}

std::vector<BenchmarkRow> benchmark_rows(const RobotModel& robot, const OnlineOptions& base) {
  Rows rows(robot, base);
  rows.add("ticks", "computing times of 100,000 plans, undisturbed trot", kTicks, 1, Events::none).is_alone = true;
  for (const char* const gait : {"trot", "walk"}) {
    BenchmarkRow& row = rows.add(fmt::format("{}_commands", gait), fmt::format("random commands, {}", gait), kLong,
                                 kFewSeeds, Events::commands);
    row.options.gait = gait;
    row.options.late = LatePlans::drop;
  }
  rows.add_kicks("kicks_0.5", 0.5, kShort, kManySeeds, Events::kicks);
  rows.add_kicks("kicks_1.0", 1.0, kShort, kFewSeeds, Events::kicks);
  for (const double kick : {0.5, 1.0})
    rows.add_kicks(fmt::format("one_kick_{:.1f}", kick), kick, kOneKick, kFewSeeds, Events::one_kick);
  for (const double kick : kCurve)
    rows.add_kicks(fmt::format("curve_{:.1f}", kick), kick, kShort, kCurveSeeds, Events::kicks);

  BenchmarkRow& loaded =
      rows.add("payload", "20 % more mass on the base, unknown", kShort, kFewSeeds, Events::commands);
  const BodyTree tree = body_tree(robot);
  loaded.options.simulation.physics.body_scales.assign(tree.bodies.size(), 1.0);
  loaded.options.simulation.physics.body_scales.front() += kPayload * robot.mass() / tree.bodies.front().mass;
  rows.add("friction", "friction 0.4 where plans assume 0.6", kShort, kFewSeeds, Events::commands)
      .options.simulation.physics.friction = kSlippery;
  rows.add("slope", "ground that rises by 10 degrees, unknown", kShort, kFewSeeds, Events::commands)
      .options.simulation.ground.tilt.y() = -kSlope * std::numbers::pi / 180.0;
  rows.add("hour", "an hour of random commands", kHour, 1, Events::commands);
  return rows.take();
}

}  // namespace prowl

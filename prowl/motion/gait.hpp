#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "prowl/model/robot_model.hpp"
#include "prowl/model/surface.hpp"
#include "prowl/motion/phase.hpp"

namespace prowl {

/// The feet of a robot on four legs: left and right fore, left and right hind.
enum class Foot { lf, rf, lh, rh };

/// Contact of each foot, by Foot: index into RobotModel::contacts().
using Feet = std::array<int, 4>;

/// Assigns contacts to feet by their positions in the nominal posture: one in each quadrant around the mean of all
/// contacts, in base axes (x forward, y left). None if a quadrant is empty or the robot does not have four contacts.
std::optional<Feet> find_feet(const RobotModel& robot);

/// Feet that swing together, one group after the other, once each in a stride.
struct GaitPattern {
  std::string name;
  std::vector<std::vector<Foot>> swings;
  double slow_duty_factor = 0.8, fast_duty_factor = 0.6;  ///< defaults, see default_duty_factor() [-]
  double stride = 3.0;   ///< default duration of a stride, times sqrt(height / gravity) [-]
  double longest = 1.0;  ///< default strides of fast gaits are shorter: at most so many heights [-]

  /// At and below this, there is no time in which all feet stand [-].
  double least_duty_factor() const { return 1.0 - 1.0 / static_cast<double>(swings.size()); }
  /// Default duration of a stride [s], and default part of it in which a foot stands [-], at this height of the base
  /// [m] and speed [m/s]. Robots of equal Froude number, speed² / (gravity height), move alike.
  double default_stride(double height, double speed) const;
  double default_duty_factor(double height, double speed) const;
};

/// walk (lateral sequence), trot, pace, bound, pronk.
const std::vector<GaitPattern>& gait_patterns();
/// The one of this name, which must be among them.
const GaitPattern& gait_pattern(const std::string& name);

/// Strides on one surface. Each group of feet lifts off an equal part of a stride after the one before, and swings for
/// (1 - duty_factor) of a stride. Above pattern.least_duty_factor() all feet stand after each swing; below it swings
/// overlap, and no foot stands between some of them.
struct Gait {
  GaitPattern pattern;
  int strides = 1;
  Duration stride;            ///< of one stride; each phase has its share of both bounds [s]
  double duty_factor = 0.75;  ///< above 0, below 1 [-]
  double start = 0.5;         ///< all feet stand before the first stride [s]
  double settle = 0.5;        ///< the same from the last landing to the end, in place of the last stand of a stride [s]
  int surface = 0;            ///< index into MotionProblem::surfaces
};

/// The phases of a gait: "start", one from each lift-off and landing to the next, "settle" from the last landing.
/// Footholds of landings are free. A phase shorter than a microsecond is left out. `first_stride`: its number in names.
std::vector<Phase> expand(const Gait& gait, const RobotModel& robot, const Feet& feet, int first_stride = 1);

/// The stride of this number, 1 ... strides, of a gait that repeats itself, from the middle of the time in which all
/// feet stand to that of the next stride. Footholds of landings are open.
std::vector<Phase> expand_cycle(const Gait& gait, const RobotModel& robot, const Feet& feet, int stride);

/// Middle of the stance in which a foot begins such a stride, from its begin [strides]; before it if negative.
double middle_of_stance(const Gait& gait, Foot foot);

/// A displacement along a surface, world frame [m]: seen from above it has this heading [rad, about world z from world
/// x]. The surface must not be vertical.
Eigen::Vector3d along_surface(const Surface& surface, double heading, double length);

/// The chord of an arc along a surface, of this length, that begins with the heading and turns by `turn` [rad].
Eigen::Vector3d along_arc(const Surface& surface, double heading, double length, double turn);

}  // namespace prowl

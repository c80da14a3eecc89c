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
  double duty_factor = 0.75;  ///< default part of a stride in which a foot stands [-]

  /// Below this, two groups would be in the air at once [-].
  double least_duty_factor() const { return 1.0 - 1.0 / static_cast<double>(swings.size()); }
};

/// walk (lateral sequence), trot, pace, bound.
const std::vector<GaitPattern>& gait_patterns();

/// Strides on one surface. In a stride, each group of feet of the pattern swings for (1 - duty_factor) of its duration;
/// the remaining time is divided equally into stands of all feet, one after each swing.
struct Gait {
  GaitPattern pattern;
  int strides = 1;
  Duration stride;            ///< of one stride; each phase has its share of both bounds [s]
  double duty_factor = 0.75;  ///< at least pattern.least_duty_factor(), below 1 [-]
  double start = 0.5;         ///< all feet stand before the first stride [s]
  double settle = 0.5;        ///< the same from the last landing to the end, in place of the last stand of a stride [s]
  int surface = 0;            ///< index into MotionProblem::surfaces
};

/// The phases of a gait: "start", swings and stands of every stride, "settle". Footholds of
/// landings are free. A stand shorter than a microsecond is left out.
std::vector<Phase> expand(const Gait& gait, const RobotModel& robot, const Feet& feet);

/// A displacement along a surface, world frame [m]: seen from above it has this heading [rad, about world z from world
/// x]. The surface must not be vertical.
Eigen::Vector3d along_surface(const Surface& surface, double heading, double length);

}  // namespace prowl

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

/// Which contact is which foot, by where they are in the nominal posture: one in each quarter around the middle of all
/// contacts, along the axes of the base (x forward, y to the left). None for a robot that is not made so, or has more
/// or fewer than four contacts.
std::optional<Feet> find_feet(const RobotModel& robot);

/// Feet that swing together, one group after the other, once each in a stride.
struct GaitPattern {
  std::string name;
  std::vector<std::vector<Foot>> swings;
  double duty_factor = 0.75;  ///< the usual part of a stride in which a foot stands [-]

  /// With less than this two groups would be in the air at once [-].
  double least_duty_factor() const { return 1.0 - 1.0 / static_cast<double>(swings.size()); }
};

/// walk (lateral sequence), trot, pace, bound.
const std::vector<GaitPattern>& gait_patterns();

/// Strides on one surface. A stride lets each group of feet of the pattern swing for (1 - duty_factor) of its duration,
/// and all feet stand for the same time after each swing, with what is left of it.
struct Gait {
  GaitPattern pattern;
  int strides = 1;
  Duration stride;            ///< of one stride; each phase has its share of both bounds [s]
  double duty_factor = 0.75;  ///< at least pattern.least_duty_factor(), below 1 [-]
  double start = 0.5;         ///< all feet stand before the first stride [s]
  double settle = 0.5;        ///< and from the last landing to the end, in place of the last stand of a stride [s]
  int surface = 0;            ///< index into MotionProblem::surfaces
};

/// The phases of a gait: "start", swings and stands of every stride, "settle". Feet that land are free to choose their
/// place. A stand shorter than a microsecond is left out.
std::vector<Phase> expand(const Gait& gait, const RobotModel& robot, const Feet& feet);

/// A displacement along a surface [m]: seen from above it goes to the heading [rad, about the world's z from its x],
/// and it climbs as the surface does. The surface must not stand upright.
Eigen::Vector3d along_surface(const Surface& surface, double heading, double length);

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/mpc/contact_timeline.hpp"
#include "prowl/mpc/ground_plane.hpp"
#include "prowl/mpc/horizon_grid.hpp"
#include "prowl/mpc/horizon_program.hpp"
#include "prowl/mpc/horizon_solver.hpp"
#include "prowl/mpc/mpc_options.hpp"

namespace prowl {

/// Bounds of the inequalities of a horizon: limits of the robot, friction of feet that stand, and the paths of feet
/// that swing and land.
class HorizonBounds {
 public:
  /// A view of both arguments.
  HorizonBounds(const HorizonProgram& program, const MpcOptions& options);

  /// The first steps, whose friction is as soft as other limits: a measured state may violate it.
  static constexpr int kSoftSteps = 2;

  /// Sets the bounds of all steps, whose states and contacts the program has.
  void set(const HorizonGrid& grid, const ContactTimeline& timeline, const GroundPlane& ground, HorizonSolver& solver);

 private:
  struct FootBounds {
    double least, most;    ///< height of its contacts [m]
    double fastest;        ///< their velocity along each axis [m/s]
    double most_friction;  ///< of their friction rows [N]
    double price_time;     ///< their height counts in the cost for so long [s]
  };
  FootBounds bounds_of(int foot, int k, double ground, const HorizonGrid& grid, const ContactTimeline& timeline) const;
  double most_friction(int foot, double t, const ContactTimeline& timeline) const;
  Eigen::Vector2d place_of(int foot, double cos, double sin) const;
  void set_limits(BarrierRows& rows, double price) const;

  const HorizonProgram& program_;
  const MpcOptions& options_;
  std::vector<Eigen::Vector2d> offsets_;  ///< of each foot from the base in the standing posture, axes of heading [m]
  Eigen::VectorXd q_, v_;
};

}  // namespace prowl

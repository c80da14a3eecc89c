#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Units of the variables of stages, from the size l and the weight m g of a robot. A regularising solver adds the same
/// curvature to each variable, so that dimensionless ones fit robots of any size.
struct VariableUnits {
  explicit VariableUnits(const RobotModel& robot);

  double length, time, force;  ///< l [m], sqrt(l / g) [s], m g [N]
  Eigen::VectorXd q;           ///< nv, of the tangent: rotations and angles in radians; velocities: q / time
  Eigen::VectorXd tau;         ///< nu
};

}  // namespace prowl

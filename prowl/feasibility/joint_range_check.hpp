#pragma once

#include <Eigen/Core>

#include "prowl/model/robot_model.hpp"

namespace prowl {

/// Lower bound on the distance of a contact point from a target, base frame [m], over all joint positions within their
/// limits; 0 if the point comes within `margin` [m] of it, or nothing is certain. By branch and bound: in a box of
/// joint positions about q, half widths r, the distance is at least that at q less the sum of lever_j r_j
/// (joint_levers()). Gives up after so many boxes as take 0.1 s, as for a leg of six joints.
double least_distance_within_limits(const RobotModel& robot, int contact, const Eigen::Vector3d& target, double margin);

}  // namespace prowl

#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>

#include "prowl/terms/term.hpp"

namespace prowl {

// Arguments that no motion can meet (a direction of no length, a reference that is no rotation) throw InputError.

/// Terms of frames of the robot: links of the URDF by their names, or "base". `relative_to` names another such frame;
/// empty: the world.

/// Position of a frame's origin [m], in the axes of the other frame: R_otherᵀ (p - p_other), rows x, y, z.
std::shared_ptr<const Term> frame_position(const std::string& frame, const std::string& relative_to = "");

/// Rotation vector [rad] of a frame from a reference orientation in the other frame: log(referenceᵀ R_otherᵀ R), rows
/// x, y, z in the axes of the reference. Exact below an angle of pi, where it has a jump.
std::shared_ptr<const Term> frame_orientation(const std::string& frame, const Eigen::Matrix3d& reference,
                                              const std::string& relative_to = "");

/// Velocity of a frame's origin in the world [m/s], world axes.
std::shared_ptr<const Term> frame_velocity(const std::string& frame);

/// Angular velocity of a frame in the world [rad/s], world axes.
std::shared_ptr<const Term> frame_angular_velocity(const std::string& frame);

/// Rotation [rad] that takes a direction of the frame to a direction of the world, both of any length but zero: two
/// rows, about two directions of the frame across `axis`. A turn about `axis` is free.
std::shared_ptr<const Term> frame_pointing_along(const std::string& frame, const Eigen::Vector3d& axis,
                                                 const Eigen::Vector3d& direction);

/// The same towards a point of the world [m], seen from the frame's origin.
std::shared_ptr<const Term> frame_pointing_at(const std::string& frame, const Eigen::Vector3d& axis,
                                              const Eigen::Vector3d& target);

}  // namespace prowl

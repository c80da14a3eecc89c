#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/transcription/contact_path.hpp"

namespace prowl {

/// How far an initial guess moves the base sideways so that the robot's weight stays over the contacts that hold, where the
/// boundary conditions leave it free to: a robot that lifts a foot first leans away from it.
///
/// A phase whose contacts do not have the centre of mass above the inner part of their support polygon pulls it there, all
/// the way if the phase is long against the time in which a robot of its height topples, l / g = T², less if it is
/// short. In between the shift goes smoothly from one to the next, and to zero where a condition binds the base.
class SupportPath {
 public:
  SupportPath(const MotionProblem& problem, const Mesh& mesh, const PosturePath& posture, const ContactPath& contacts);

  Eigen::Vector2d operator()(double time) const;  ///< world x y [m]

 private:
  std::vector<MonotoneCubic> curves_;  ///< x and y
};

}  // namespace prowl

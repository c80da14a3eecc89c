#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/guess/contact_path.hpp"

namespace prowl {

/// How far an initial guess moves the base sideways so that its contacts can carry the motion, where the boundary
/// conditions leave it free to: a robot that lifts a foot leans away from it before.
///
/// As a linear inverted pendulum of the nominal height z: the zero moment point  p = c - (z / g) c̈  of the centre of
/// mass c has to be in the inner part of the support polygon of each phase. Least squares of its distance from there
/// and, a little, of the acceleration, where each round aims for the points that are nearest to the last round's. At
/// rest at both ends, no shift where a condition binds the base; phases in flight aim for nothing. Kajita et al., Biped
/// walking pattern generation by using preview control of zero-moment point, ICRA 2003.
class SupportPath {
 public:
  SupportPath(const DiscreteProblem& discrete, const PosturePath& posture, const ContactPath& contacts);

  Eigen::Vector2d operator()(double time) const;  ///< world x y [m]

 private:
  std::vector<MonotoneCubic> curves_;  ///< x and y
};

}  // namespace prowl

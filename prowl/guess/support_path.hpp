#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/guess/contact_path.hpp"

namespace prowl {

/// Sideways shift of the base in an initial guess, within the boundary constraints, with which its contacts can carry
/// the motion: a robot leans away from a foot before lifting it.
///
/// Linear inverted pendulum of the nominal height z: the zero moment point  p = c - (z / g) c̈  of the centre of mass c
/// must be in the inner part of the support polygon of each phase, but for flights. Least squares of its distance from
/// there and, with a small weight, of the acceleration; each round aims for the points nearest to the last round's. At
/// rest at both ends, no shift where a condition binds the base. Kajita et al., Biped walking pattern generation by
/// using preview control of zero-moment point, ICRA 2003.
class SupportPath {
 public:
  SupportPath(const DiscreteProblem& discrete, const PosturePath& posture, const ContactPath& contacts);

  Eigen::Vector2d operator()(double time) const;  ///< world x y [m]

 private:
  std::vector<MonotoneCubic> curves_;  ///< x and y
};

}  // namespace prowl

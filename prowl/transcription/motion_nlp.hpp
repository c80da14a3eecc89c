#pragma once

#include <Eigen/Core>

#include "prowl/nlp/nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl {

/// A motion problem on a mesh as a nonlinear program, whatever its variables are.
class MotionNlp : public Nlp {
 public:
  /// From a motion with one point a node of the mesh.
  virtual Eigen::VectorXd pack(const Trajectory& trajectory) const = 0;
  /// At the nodes of the mesh, with contact forces. Throws NumericalError if z is not finite.
  virtual Trajectory unpack(const Eigen::VectorXd& z) = 0;

  /// The certificate reads a motion with the interpolation of the trapezoid. A program that means another one between its
  /// nodes gives a motion with more of them: each interval of the mesh in so many equal parts.
  virtual int parts() const { return 1; }
  /// At the nodes of a mesh with parts() intervals for each of the program's.
  virtual Trajectory motion(const Eigen::VectorXd& z) { return unpack(z); }

  virtual void use_hessian(HessianKind kind) = 0;  ///< exact, if not said otherwise
};

}  // namespace prowl

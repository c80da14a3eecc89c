#pragma once

#include <Eigen/Core>

#include "prowl/nlp/stored_nlp.hpp"
#include "prowl/trajectory/trajectory.hpp"
#include "prowl/transcription/hessian_kind.hpp"

namespace prowl {

/// A motion problem on a mesh as a nonlinear program, whatever its variables are.
class MotionNlp : public StoredNlp {
 public:
  /// From a motion with one point a node of the mesh.
  virtual Eigen::VectorXd pack(const Trajectory& trajectory) const = 0;
  /// At the nodes of the mesh, with contact forces, and how it runs between them. Throws NumericalError if z is not
  /// finite.
  virtual Trajectory unpack(const Eigen::VectorXd& z) = 0;

  virtual void use_hessian(HessianKind kind) = 0;  ///< exact, if not said otherwise
};

}  // namespace prowl

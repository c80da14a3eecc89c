#pragma once

#include <Eigen/Core>

#include "prowl/nlp/nlp.hpp"

namespace prowl {

/// How far z is from a stationary point of the Lagrangian L = f + multipliers . g within the bounds of the variables:
///
///   max_i | clip(z − ∇L, lower, upper) − z |_i
///
/// 0 where ∇L vanishes, and where it pushes a variable against its bound. For a z inside its bounds.
double dual_violation(Nlp& nlp, const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers);

}  // namespace prowl

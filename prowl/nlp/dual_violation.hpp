#pragma once

#include <Eigen/Core>

#include "prowl/nlp/nlp.hpp"

namespace prowl {

/// Distance of z from a stationary point of the Lagrangian L = f + multipliers . g within the bounds of the variables:
///
///   max_i | clip(z − ∇L, lower, upper) − z |_i
///
/// 0 if ∇L vanishes or pushes variables against their bounds. z must be inside its bounds.
double dual_violation(Nlp& nlp, const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers);

}  // namespace prowl

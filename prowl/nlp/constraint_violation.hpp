#pragma once

#include <Eigen/Core>

#include "prowl/nlp/nlp.hpp"

namespace prowl {

/// Violation of the bounds by z and g = g(z):
///
///   max_i max(0, lower_i - value_i, value_i - upper_i)   over variables and constraints, each in its own unit.
///
/// NaN counts as infinity.
double constraint_violation(const Nlp& nlp, const Eigen::VectorXd& z, const Eigen::VectorXd& g);

}  // namespace prowl

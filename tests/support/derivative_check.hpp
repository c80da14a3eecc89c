#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/nlp.hpp"

namespace prowl::test {

/// The entry of a derivative that differs most from the central difference d = (F(z + h e_j) - F(z - h e_j)) / 2h.
struct DerivativeError {
  double relative = 0.0;  ///< |value - d| / max(1, |value|, |d|)
  double value = 0.0;     ///< as the Nlp gives it
  double difference = 0.0;
  int row = -1;
  int col = -1;
  std::string where;  ///< constraint and variable in words; empty if nothing was compared
};

struct DerivativeReport {
  DerivativeError gradient;
  DerivativeError jacobian;
  DerivativeError hessian;
  /// Places outside the range of the matrix, named twice or, for the Hessian, above the diagonal; and derivatives that
  /// are not zero outside the pattern. Empty if the patterns are right at this point.
  std::vector<std::string> pattern_faults;

  double worst() const;         ///< largest relative error of the three
  std::string summary() const;  ///< one line each, for a test's message
};

struct DerivativeCheckOptions {
  double step = 5e-5;  ///< h = step max(1, |z_j|); fourth-order differences: truncation h^4, rounding eps / h
  double outside_tolerance = 1e-6;  ///< |d| above this outside the pattern is a fault
};

/// Compares the gradient of the cost and the Jacobian of the constraints with differences of the values, and the
/// Hessian of cost_factor f + multipliers . g with differences of its gradient (so read `hessian` only if the other two
/// are right). Takes 4 n evaluations of everything.
DerivativeReport check_derivatives(Nlp& nlp, const Eigen::VectorXd& z, double cost_factor,
                                   const Eigen::VectorXd& multipliers, const DerivativeCheckOptions& options = {});

}  // namespace prowl::test

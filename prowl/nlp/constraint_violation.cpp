#include "prowl/nlp/constraint_violation.hpp"

#include <algorithm>
#include <limits>

namespace prowl {
namespace {

double violation(const Eigen::VectorXd& value, const Eigen::VectorXd& lower, const Eigen::VectorXd& upper) {
  if (value.size() == 0) return 0.0;
  if (value.hasNaN()) return std::numeric_limits<double>::infinity();
  return std::max({0.0, (lower - value).maxCoeff(), (value - upper).maxCoeff()});
}

}  // namespace

double constraint_violation(const Nlp& nlp, const Eigen::VectorXd& z, const Eigen::VectorXd& g) {
  return std::max(violation(z, nlp.variable_lower(), nlp.variable_upper()),
                  violation(g, nlp.constraint_lower(), nlp.constraint_upper()));
}

}  // namespace prowl

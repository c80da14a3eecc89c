#include "prowl/nlp/dual_violation.hpp"

namespace prowl {

double dual_violation(Nlp& nlp, const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers) {
  if (z.size() == 0) return 0.0;
  const SparsityPattern& pattern = nlp.jacobian_pattern();
  Eigen::VectorXd gradient(z.size()), jacobian(pattern.size());
  nlp.cost_gradient(z, gradient);
  nlp.jacobian(z, jacobian);
  for (int i = 0; i < pattern.size(); ++i) {
    gradient(pattern.cols[i]) += multipliers(pattern.rows[i]) * jacobian(i);
  }
  return ((z - gradient).cwiseMax(nlp.variable_lower()).cwiseMin(nlp.variable_upper()) - z).lpNorm<Eigen::Infinity>();
}

}  // namespace prowl

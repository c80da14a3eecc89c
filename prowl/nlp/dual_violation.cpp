#include "prowl/nlp/dual_violation.hpp"

namespace prowl {

double dual_violation(Nlp& nlp, const Eigen::VectorXd& z, const Eigen::VectorXd& multipliers) {
  if (z.size() == 0) return 0.0;
  const SparsityPattern& pattern = nlp.jacobian_pattern();
  Eigen::VectorXd gradient(z.size()), jacobian(pattern.size());
  nlp.cost_gradient(z, gradient);
  nlp.jacobian(z, jacobian);
  for (int i = 0; i < pattern.size(); ++i) {
    const auto place = static_cast<std::size_t>(i);
    gradient(pattern.cols[place]) += multipliers(pattern.rows[place]) * jacobian(i);
  }
  return ((z - gradient).cwiseMax(nlp.variable_lower()).cwiseMin(nlp.variable_upper()) - z).lpNorm<Eigen::Infinity>();
}

}  // namespace prowl

#include "tests/support/dense_stagewise_nlp.hpp"

namespace prowl::test {

using Eigen::MatrixXd;
using Eigen::VectorXd;

void DenseStagewiseNlp::linearise(int k, const VectorXd& ux, double cost_factor, const StageMultipliers& multipliers) {
  linearise_to_first_order(k, ux);
  models_[k].hessian = hessian(k, ux, cost_factor, multipliers);
}

void DenseStagewiseNlp::linearise_to_first_order(int k, const VectorXd& ux) {
  models_.resize(num_stages());
  values(k, ux);
  models_[k].slopes = derivatives(k, ux);
}

void DenseStagewiseNlp::add_condensed(int k, const MatrixXd& next_hessian, const VectorXd& weights, MatrixXd& result) {
  const StageDerivatives& slopes = model(k).slopes;
  result.noalias() += slopes.inequalities.transpose() * weights.asDiagonal() * slopes.inequalities;
  if (slopes.next.rows() > 0) result += slopes.next.transpose() * next_hessian * slopes.next;
}

void DenseStagewiseNlp::push_forward(int k, const VectorXd& step, VectorXd& next, VectorXd& inequalities) {
  next.noalias() = model(k).slopes.next * step;
  inequalities.noalias() = model(k).slopes.inequalities * step;
}

void DenseStagewiseNlp::add_pull_back(int k, const VectorXd& on_next, const VectorXd& on_inequalities,
                                      VectorXd& gradient) {
  if (on_next.size() > 0) gradient.noalias() += model(k).slopes.next.transpose() * on_next;
  if (on_inequalities.size() > 0) gradient.noalias() += model(k).slopes.inequalities.transpose() * on_inequalities;
}

}  // namespace prowl::test

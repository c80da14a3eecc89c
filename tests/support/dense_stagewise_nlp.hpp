#pragma once

#include <Eigen/Core>
#include <vector>

#include "prowl/nlp/stagewise_nlp.hpp"

namespace prowl::test {

/// The functions for linearised stages by dense matrices, for chains without a structure of their own.
class DenseStagewiseNlp : public StagewiseNlp {
 public:
  void linearise(int k, const Eigen::VectorXd& ux, double cost_factor, const StageMultipliers& multipliers) override;
  void linearise_to_first_order(int k, const Eigen::VectorXd& ux) override;
  const Eigen::VectorXd& cost_gradient(int k) const override { return model(k).slopes.cost_gradient; }
  const Eigen::MatrixXd& equality_slopes(int k) const override { return model(k).slopes.equalities; }
  const Eigen::MatrixXd& lagrangian_hessian(int k) const override { return model(k).hessian; }
  void add_condensed(int k, const Eigen::MatrixXd& next_hessian, const Eigen::VectorXd& weights,
                     Eigen::MatrixXd& result) override;
  void push_forward(int k, const Eigen::VectorXd& step, Eigen::VectorXd& next, Eigen::VectorXd& inequalities) override;
  void add_pull_back(int k, const Eigen::VectorXd& on_next, const Eigen::VectorXd& on_inequalities,
                     Eigen::VectorXd& gradient) override;

 private:
  struct Model {
    StageDerivatives slopes;
    Eigen::MatrixXd hessian;
  };
  const Model& model(int k) const { return models_[k]; }
  std::vector<Model> models_;
};

}  // namespace prowl::test

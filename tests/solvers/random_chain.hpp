#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "tests/support/dense_stagewise_nlp.hpp"
#include "tests/support/random_vector.hpp"

namespace prowl::test {

/// A chain whose derivatives are data, for tests of linear algebra: it has no values.
class RandomChain : public DenseStagewiseNlp {
 public:
  struct Part {
    StageSize size;
    StageDerivatives slopes;
    Eigen::MatrixXd hessian;
  };

  /// All entries of all matrices in [-1, 1], Hessians positive definite.
  RandomChain(std::mt19937& rng, const std::vector<StageSize>& sizes) {
    for (std::size_t k = 0; k < sizes.size(); ++k) {
      const StageSize& size = sizes[k];
      const int next = k + 1 < sizes.size() ? sizes[k + 1].states : 0, n = size.variables();
      Part part{size,
                {random_vector(rng, n, 1.0), random_matrix(rng, next, n), random_matrix(rng, size.equalities, n),
                 random_matrix(rng, size.inequalities, n)},
                {}};
      const Eigen::MatrixXd root = random_matrix(rng, n, n);
      part.hessian = root * root.transpose() + 0.1 * Eigen::MatrixXd::Identity(n, n);
      parts.push_back(part);
    }
  }

  void linearise_all() {
    for (int k = 0; k < num_stages(); ++k) linearise(k, Eigen::VectorXd::Zero(size(k).variables()), 1.0, {});
  }

  int num_stages() const override { return static_cast<int>(parts.size()); }
  const StageSize& size(int k) const override { return parts[k].size; }
  const Eigen::VectorXd& lower(int) const override { return nothing_; }
  const Eigen::VectorXd& upper(int) const override { return nothing_; }
  const Eigen::MatrixXd& closure() const override { return closing; }
  const StageValues& values(int, const Eigen::VectorXd&) override { return no_values_; }
  const StageDerivatives& derivatives(int k, const Eigen::VectorXd&) override { return parts[k].slopes; }
  const Eigen::MatrixXd& hessian(int k, const Eigen::VectorXd&, double, const StageMultipliers&) override {
    return parts[k].hessian;
  }
  std::vector<Eigen::VectorXd> stages(const Eigen::VectorXd&) const override { return {}; }
  Eigen::VectorXd flat(const std::vector<Eigen::VectorXd>&) const override { return {}; }
  std::string describe_stage(int k) const override { return "stage " + std::to_string(k); }

  std::vector<Part> parts;
  Eigen::MatrixXd closing;  ///< see StagewiseNlp::closure()

 private:
  Eigen::VectorXd nothing_;
  StageValues no_values_;
};

}  // namespace prowl::test

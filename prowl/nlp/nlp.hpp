#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/stagewise_nlp.hpp"

namespace prowl {

/// Positions of the non-zeros of a sparse matrix, each once; values have the same order.
struct SparsityPattern {
  std::vector<int> rows;
  std::vector<int> cols;
  int size() const { return static_cast<int>(rows.size()); }
};

/// Nonlinear program: minimise f(z) subject to z_lower <= z <= z_upper, g_lower <= g(z) <= g_upper.
/// Sizes, bounds and sparsity are fixed at construction; +-inf where there is no bound.
/// Evaluations may reuse internal work space: one Nlp, one thread (but see use_threads()). They may throw
/// NumericalError.
class Nlp {
 public:
  virtual ~Nlp() = default;

  virtual int num_variables() const = 0;
  virtual int num_constraints() const = 0;
  virtual const Eigen::VectorXd& variable_lower() const = 0;
  virtual const Eigen::VectorXd& variable_upper() const = 0;
  virtual const Eigen::VectorXd& constraint_lower() const = 0;
  virtual const Eigen::VectorXd& constraint_upper() const = 0;
  virtual const SparsityPattern& jacobian_pattern() const = 0;
  virtual const SparsityPattern& hessian_pattern() const = 0;  ///< lower triangle, row >= col

  virtual double cost(const Eigen::VectorXd& z) = 0;
  virtual void cost_gradient(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> gradient) = 0;
  virtual void constraints(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> g) = 0;
  virtual void jacobian(const Eigen::VectorXd& z, Eigen::Ref<Eigen::VectorXd> values) = 0;
  /// Hessian of cost_factor * f(z) + multipliers . g(z).
  virtual void hessian(const Eigen::VectorXd& z, double cost_factor, const Eigen::VectorXd& multipliers,
                       Eigen::Ref<Eigen::VectorXd> values) = 0;

  /// In the words of the task, e.g. "phase 2, lh_foot, friction cone, t = 0.41 s".
  virtual std::string describe_constraint(int row) const = 0;
  virtual std::string describe_variable(int index) const = 0;

  /// Allows `count` threads in an evaluation, and as many of a ThreadTeam to evaluate different stages at once. Returns
  /// the number that it supports, 1 to `count`. Results do not depend on it.
  virtual int use_threads(int /*count*/) { return 1; }

  /// The same program as a chain of stages, if it is one; valid as long as the Nlp is.
  virtual StagewiseNlp* stagewise() { return nullptr; }
};

}  // namespace prowl

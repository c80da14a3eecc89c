#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "prowl/nlp/linearised_chain.hpp"

namespace prowl {

struct StageValues {
  double cost = 0.0;
  Eigen::VectorXd next, equalities, inequalities;
};

/// Derivatives in (u, x). `next`, `equalities` and `inequalities` have one row per function.
struct StageDerivatives {
  Eigen::VectorXd cost_gradient;
  Eigen::MatrixXd next, equalities, inequalities;
};

struct StageMultipliers {
  Eigen::VectorXd next, equalities, inequalities;
};

/// An Nlp as a chain of stages k = 0 ... num_stages() - 1 with inputs u and states x, for dynamic programming:
///
///   minimise   sum of cost_k(u_k, x_k)   subject to   x_{k+1} = next_k(u_k, x_k)   (not after the last stage),
///   equalities_k(u_k, x_k) = 0,   lower_k <= inequalities_k(u_k, x_k) <= upper_k
///
/// The variables of a stage are one vector (u_k, x_k). Bounds on variables are rows here. Fixed variables may be left
/// out; the first stage has only free states. Evaluations may throw NumericalError. Their results are valid until the
/// next evaluation of that stage.
class StagewiseNlp : public LinearisedChain {
 public:
  virtual const Eigen::VectorXd& lower(int k) const = 0;  ///< of the inequalities
  virtual const Eigen::VectorXd& upper(int k) const = 0;

  virtual const StageValues& values(int k, const Eigen::VectorXd& ux) = 0;
  virtual const StageDerivatives& derivatives(int k, const Eigen::VectorXd& ux) = 0;
  /// Hessian of cost_factor * cost + multipliers . (next, equalities, inequalities) in (u, x), symmetric.
  virtual const Eigen::MatrixXd& hessian(int k, const Eigen::VectorXd& ux, double cost_factor,
                                         const StageMultipliers& multipliers) = 0;

  /// Evaluates values and all derivatives of a stage for the functions of LinearisedChain, which use its structure
  /// instead of the dense matrices above. Their results are valid until the next linearise(), derivatives() or
  /// hessian() of the stage.
  virtual void linearise(int k, const Eigen::VectorXd& ux, double cost_factor, const StageMultipliers& multipliers) = 0;
  /// The same without second derivatives: lagrangian_hessian() is then undefined.
  virtual void linearise_to_first_order(int k, const Eigen::VectorXd& ux) = 0;
  virtual const Eigen::VectorXd& cost_gradient(int k) const = 0;

  /// Converts the variables of the Nlp to those of each stage, and back.
  virtual std::vector<Eigen::VectorXd> stages(const Eigen::VectorXd& z) const = 0;
  virtual Eigen::VectorXd flat(const std::vector<Eigen::VectorXd>& stages) const = 0;

  /// In the words of the task, e.g. "phase 2, node 3, t = 0.41 s".
  virtual std::string describe_stage(int k) const = 0;
};

}  // namespace prowl

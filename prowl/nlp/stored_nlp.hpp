#pragma once

#include <Eigen/Core>

#include "prowl/nlp/nlp.hpp"

namespace prowl {

/// An Nlp that stores bounds and patterns; derived constructors fill them in. Sizes are those of the bounds.
class StoredNlp : public Nlp {
 public:
  int num_variables() const override { return static_cast<int>(variable_lower_.size()); }
  int num_constraints() const override { return static_cast<int>(constraint_lower_.size()); }
  const Eigen::VectorXd& variable_lower() const override { return variable_lower_; }
  const Eigen::VectorXd& variable_upper() const override { return variable_upper_; }
  const Eigen::VectorXd& constraint_lower() const override { return constraint_lower_; }
  const Eigen::VectorXd& constraint_upper() const override { return constraint_upper_; }
  const SparsityPattern& jacobian_pattern() const override { return jacobian_pattern_; }
  const SparsityPattern& hessian_pattern() const override { return hessian_pattern_; }

 protected:
  Eigen::VectorXd variable_lower_, variable_upper_, constraint_lower_, constraint_upper_;
  SparsityPattern jacobian_pattern_, hessian_pattern_;
};

}  // namespace prowl

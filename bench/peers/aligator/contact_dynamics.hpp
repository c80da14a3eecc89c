#pragma once

#include <aligator/core/function-abstract.hpp>
#include <aligator/modelling/dynamics/multibody-constraint-fwd.hpp>

namespace peer {

using Dynamics = aligator::dynamics::MultibodyConstraintFwdDynamicsTpl<double>;

/// Accelerations of all coordinates and forces of the contacts, three world axes each, as a function of state and
/// torque.
///
/// Aligator's own residual has the force of one contact and solves the dynamics again for each. This one solves them
/// once.
class ContactDynamics : public aligator::StageFunctionTpl<double> {
 public:
  ContactDynamics(const Dynamics& dynamics, int num_inputs);

  void evaluate(const ConstVectorRef& x, const ConstVectorRef& u, Data& data) const override;
  /// At the state and torque of the last evaluate() with this data, as in Aligator's residuals.
  void computeJacobians(const ConstVectorRef& x, const ConstVectorRef& u, Data& data) const override;
  std::shared_ptr<Data> createData() const override;

 private:
  Dynamics dynamics_;
};

}  // namespace peer

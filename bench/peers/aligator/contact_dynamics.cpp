#include "contact_dynamics.hpp"

#include <pinocchio/algorithm/constrained-dynamics-derivatives.hpp>
#include <pinocchio/algorithm/constrained-dynamics.hpp>

namespace peer {

namespace {

using Base = aligator::StageFunctionDataTpl<double>;

struct Solved : Base {
  Solved(const ContactDynamics& model, const Dynamics& dynamics)
      : Base(model), pin(dynamics.pinModel()), settings(dynamics.prox_settings_) {
    for (const auto& constraint : dynamics.constraint_models_) constraints.emplace_back(constraint);
    pinocchio::initConstraintDynamics(dynamics.pinModel(), pin, dynamics.constraint_models_, constraints);
  }

  pinocchio::Data pin;
  Dynamics::RigidConstraintDataVector constraints;
  pinocchio::ProximalSettings settings;
};

}  // namespace

ContactDynamics::ContactDynamics(const Dynamics& dynamics, int num_inputs)
    : StageFunctionTpl(dynamics.ndx(), num_inputs,
                       dynamics.pinModel().nv + 3 * static_cast<int>(dynamics.constraint_models_.size())),
      dynamics_(dynamics) {}

void ContactDynamics::evaluate(const ConstVectorRef& x, const ConstVectorRef& u, Data& data) const {
  auto& solved = static_cast<Solved&>(data);
  const auto& model = dynamics_.pinModel();
  pinocchio::constraintDynamics(model, solved.pin, x.head(model.nq), x.tail(model.nv), dynamics_.actuation_matrix_ * u,
                                dynamics_.constraint_models_, solved.constraints, solved.settings);
  data.value_.head(model.nv) = solved.pin.ddq;
  for (std::size_t i = 0; i < solved.constraints.size(); ++i)
    data.value_.segment<3>(model.nv + 3 * static_cast<Eigen::Index>(i)) = solved.constraints[i].contact_force.linear();
}

void ContactDynamics::computeJacobians(const ConstVectorRef&, const ConstVectorRef&, Data& data) const {
  auto& solved = static_cast<Solved&>(data);
  const auto& model = dynamics_.pinModel();
  pinocchio::computeConstraintDynamicsDerivatives(model, solved.pin, dynamics_.constraint_models_, solved.constraints,
                                                  solved.settings);
  const Eigen::Index nv = model.nv, forces = nr - nv;
  data.Jx_.topLeftCorner(nv, nv) = solved.pin.ddq_dq;
  data.Jx_.topRightCorner(nv, nv) = solved.pin.ddq_dv;
  data.Ju_.topRows(nv) = solved.pin.ddq_dtau * dynamics_.actuation_matrix_;
  data.Jx_.bottomLeftCorner(forces, nv) = solved.pin.dlambda_dq;
  data.Jx_.bottomRightCorner(forces, nv) = solved.pin.dlambda_dv;
  data.Ju_.bottomRows(forces) = solved.pin.dlambda_dtau * dynamics_.actuation_matrix_;
}

std::shared_ptr<ContactDynamics::Data> ContactDynamics::createData() const {
  return std::make_shared<Solved>(*this, dynamics_);
}

}  // namespace peer

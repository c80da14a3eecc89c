#include "alternatives/collocation/dynamics/dynamics_form.hpp"

namespace prowl {

/// a and tau are variables, the projected dynamics c(q, v, a, tau) = 0 rows
/// (docs/theory.md#inverse-form): the defaults of DynamicsForm.
std::unique_ptr<DynamicsForm> inverse_dynamics() { return std::make_unique<DynamicsForm>(); }

}  // namespace prowl

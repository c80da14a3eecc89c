#include "alternatives/collocation/dynamics/dynamics_form.hpp"

namespace prowl {

/// a and tau are variables, c(q, v, a, tau) = 0 rows: projected (docs/theory.md#inverse-form). That is what a form is
/// without more.
std::unique_ptr<DynamicsForm> inverse_dynamics() { return std::make_unique<DynamicsForm>(); }

}  // namespace prowl

#pragma once

#include <string>
#include <vector>

namespace prowl {

/// Which quantities of the dynamics are decision variables of a collocation program.
struct DynamicsForm {
  std::string name;
  bool eliminates_acceleration = false;  ///< a is a function of the others; else a variable, with the dynamics as rows
  bool has_forces = false;               ///< contact forces are variables, with J a + J̇ v = 0 as rows; else recovered
};

/// All there are; the default first.
///   inverse   a, tau variables, c(q, v, a, tau) = 0: projected (docs/theory.md#inverse-form)
///   forward   tau only, a = Mc⁻¹ (P (S' tau − h) + M C v): as Pardo et al. 2016 have it
///   kkt       a, tau, f variables, M a + h − S' tau − J' f = 0 and J a + J̇ v = 0
const std::vector<DynamicsForm>& dynamics_forms();

}  // namespace prowl

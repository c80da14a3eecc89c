#include "prowl/formulations/dynamics_form.hpp"

namespace prowl {

const std::vector<DynamicsForm>& dynamics_forms() {
  static const std::vector<DynamicsForm> forms = {
      {.name = "inverse"},
      {.name = "forward", .eliminates_acceleration = true},
      {.name = "kkt", .has_forces = true},
  };
  return forms;
}

}  // namespace prowl

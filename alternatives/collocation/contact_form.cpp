#include "alternatives/collocation/contact_form.hpp"

namespace prowl {

const std::vector<ContactForm>& contact_forms() {
  // 5 mm: exact equality at every node over-determines the problem, which SNOPT reports as
  // infeasible (docs/formulations.md).
  constexpr double kLoose = 5e-3;
  static const std::vector<ContactForm> forms = {
      {.name = "stabilised", .stabilised = true},
      {.name = "distance", .distance = true},
      {.name = "distance-5mm", .distance = true, .tolerance = kLoose},
      {.name = "distance-velocity", .distance = true, .velocity = true},
      {.name = "distance-velocity-acceleration", .distance = true, .velocity = true, .acceleration = true},
  };
  return forms;
}

}  // namespace prowl

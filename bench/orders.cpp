// Errors of the rules of integration over the step, as CSV: HyQ moved by given torques, state at the end against a fine
// mesh. docs/formulations.md has the picture.
#include <fmt/format.h>

#include "tests/support/given_torques.hpp"

int main() {
  using namespace prowl;
  const TrajectoryPoint truth = test::end_of_given_motion({.transcription = "hermite-simpson"}, 128);
  fmt::print("rule,step_s,q,v\n");
  for (const Formulation& formulation :
       {Formulation{.transcription = "trapezoid"}, Formulation{.transcription = "hermite-simpson"},
        Formulation{.dynamics = "forward", .transcription = "rk4"}}) {
    for (const int intervals : {4, 8, 16, 32}) {
      const test::StateError error = test::state_error(test::end_of_given_motion(formulation, intervals), truth);
      fmt::print("{},{},{:.6e},{:.6e}\n", formulation.transcription, test::kGivenDuration / intervals, error.q,
                 error.v);
    }
  }
}

#include "alternatives/formulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "alternatives/formulation_library.hpp"
#include "prowl/error.hpp"
#include "prowl/files/shared_library.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

using Names = std::vector<std::string>;

void check(const char* what, const std::string& name, const Names& allowed) {
  if (std::ranges::find(allowed, name) != allowed.end()) return;
  throw InputError(fmt::format("{}: \"{}\" is not allowed; need one of {}", what, name, fmt::join(allowed, ", ")));
}

}  // namespace

const Names& dynamics_names() {
  static const Names names = {"inverse", "forward", "kkt", "centroidal"};
  return names;
}

const Names& transcription_names() {
  static const Names names = {"trapezoid", "hermite-simpson", "hermite-simpson-separated", "rk4"};
  return names;
}

const Names& contact_names() {
  static const Names names = {"stabilised", "distance", "distance-5mm", "distance-velocity",
                              "distance-velocity-acceleration"};
  return names;
}

const Names& orientation_names() {
  static const Names names = {"se3", "euler"};
  return names;
}

std::unique_ptr<MotionNlp> make_formulation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess) {
  if (formulation == Formulation{}) return std::make_unique<Transcription>(discrete, guess);
  return make_collocation(formulation, discrete, guess);
}

std::unique_ptr<MotionNlp> make_collocation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess) {
  check("dynamics", formulation.dynamics, dynamics_names());
  check("transcription", formulation.transcription, transcription_names());
  check("contact", formulation.contact, contact_names());
  check("orientation", formulation.orientation, orientation_names());
  if (!discrete.problem.terms.empty()) throw InputError("terms: only the default formulation has terms of the user's");
  if (!discrete.mesh.is_even()) {
    throw InputError("phases.shares: only the default formulation allows steps of different length within a phase");
  }
  void* const make =
      load_function(kFormulationLibrary, kMakeFormulation,
                    "formulation: only the default is installed, in a clone scripts/setup builds the others");
  return std::unique_ptr<MotionNlp>(reinterpret_cast<MakeFormulation>(make)(formulation, discrete, guess));
}

}  // namespace prowl

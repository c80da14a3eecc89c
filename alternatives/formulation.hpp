#pragma once

#include <memory>
#include <string>
#include <vector>

#include "prowl/transcription/motion_nlp.hpp"

namespace prowl {

/// One way to write a motion problem as a nonlinear program: four choices (docs/formulations.md).
/// The default is the program of make_plan().
struct Formulation {
  std::string dynamics = "inverse";
  std::string transcription = "trapezoid";
  std::string contact = "stabilised";
  std::string orientation = "se3";

  bool operator==(const Formulation&) const = default;
};

/// Valid choices, the default first.
const std::vector<std::string>& dynamics_names();
const std::vector<std::string>& transcription_names();
const std::vector<std::string>& contact_names();
const std::vector<std::string>& orientation_names();

/// Builds the program about a guess with one point per node. `discrete` must outlive it. Throws
/// InputError for unknown or incompatible choices, or a problem that the formulation does not
/// support.
std::unique_ptr<MotionNlp> make_formulation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess);

/// The same, but a Collocation even for the default choices, to check Transcription against it.
std::unique_ptr<MotionNlp> make_collocation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess);

}  // namespace prowl

#pragma once

#include <memory>
#include <string>
#include <vector>

#include "prowl/transcription/motion_nlp.hpp"

namespace prowl {

/// One way to write a motion problem as a nonlinear program: a choice in each of four questions (docs/formulations.md).
/// The default is what make_plan() solves.
struct Formulation {
  std::string dynamics = "inverse";
  std::string transcription = "trapezoid";
  std::string contact = "stabilised";
  std::string orientation = "se3";

  bool operator==(const Formulation&) const = default;
};

/// What may be chosen; the default first.
const std::vector<std::string>& dynamics_names();
const std::vector<std::string>& transcription_names();
const std::vector<std::string>& contact_names();
const std::vector<std::string>& orientation_names();

/// Of the problem, which must outlive the program, about a guess with one point a node. Throws InputError if there is
/// no such choice, if two of the four do not go together, or if the problem asks for something that the formulation has
/// not.
std::unique_ptr<MotionNlp> make_formulation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess);

/// The same, but as a collocation in coordinates also where the choice is the default: to check the one by the other.
std::unique_ptr<MotionNlp> make_collocation(const Formulation& formulation, const DiscreteProblem& discrete,
                                            const Trajectory& guess);

}  // namespace prowl

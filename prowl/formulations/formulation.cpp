#include "prowl/formulations/formulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "prowl/error.hpp"
#include "prowl/transcription/transcription.hpp"

namespace prowl {

namespace {

void check(const char* what, const std::string& name, const std::vector<std::string>& allowed) {
  if (std::ranges::find(allowed, name) != allowed.end()) return;
  throw InputError(fmt::format("{}: \"{}\" is not allowed; need one of {}", what, name, fmt::join(allowed, ", ")));
}

}  // namespace

const std::vector<std::string>& dynamics_names() {
  static const std::vector<std::string> names = {"inverse"};
  return names;
}

const std::vector<std::string>& transcription_names() {
  static const std::vector<std::string> names = {"trapezoid"};
  return names;
}

const std::vector<std::string>& contact_names() {
  static const std::vector<std::string> names = {"stabilised"};
  return names;
}

const std::vector<std::string>& orientation_names() {
  static const std::vector<std::string> names = {"se3"};
  return names;
}

std::unique_ptr<MotionNlp> make_formulation(const Formulation& formulation, const MotionProblem& problem,
                                            const Mesh& mesh, const Trajectory& guess) {
  check("dynamics", formulation.dynamics, dynamics_names());
  check("transcription", formulation.transcription, transcription_names());
  check("contact", formulation.contact, contact_names());
  check("orientation", formulation.orientation, orientation_names());
  return std::make_unique<Transcription>(problem, mesh, guess);
}

}  // namespace prowl

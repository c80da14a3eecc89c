#include "alternatives/guess_choice.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "alternatives/straight_guess.hpp"
#include "prowl/error.hpp"
#include "prowl/guess/initial_guess.hpp"

namespace prowl {

const std::vector<std::string>& guess_names() {
  static const std::vector<std::string> names = {"smooth", "straight"};
  return names;
}

Trajectory make_guess(const std::string& name, const DiscreteProblem& discrete) {
  if (name == "smooth") return initial_guess(discrete);
  if (name == "straight") return straight_guess(discrete);
  throw InputError(fmt::format("guess: \"{}\" is not allowed; need one of {}", name, fmt::join(guess_names(), ", ")));
}

}  // namespace prowl

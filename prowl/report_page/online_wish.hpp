#pragma once

#include <optional>
#include <string>

#include "prowl/online/online_run.hpp"

namespace prowl {

/// What the page of a run that goes on asks for.
struct OnlineWish {
  std::optional<TimedCommand> command;
  std::optional<double> kick;  ///< in a random direction, impulse over mass [m/s]
};
/// From a message of the page. Throws InputError if it is none.
OnlineWish parse_wish(const std::string& json);

}  // namespace prowl

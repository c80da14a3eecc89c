#include "prowl/text/option_check.hpp"

#include <fmt/format.h>

#include "prowl/error.hpp"

namespace prowl {

void check_option(bool is_allowed, const std::string& name, double value, const std::string& needed) {
  if (!is_allowed) throw InputError(fmt::format("{}: {:g} is not allowed; need {}", name, value, needed));
}

}  // namespace prowl

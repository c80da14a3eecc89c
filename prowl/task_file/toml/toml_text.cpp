#include "prowl/task_file/toml/toml_text.hpp"

#include <toml++/toml.h>

#include <sstream>

namespace prowl {

std::string toml_string(const std::string& text) {
  const toml::value<std::string> value(text);
  std::ostringstream quoted;
  quoted << toml::toml_formatter(value, toml::format_flags::none);
  return quoted.str();
}

}  // namespace prowl

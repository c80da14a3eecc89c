#pragma once

#include <string>

namespace prowl {

/// `text` as a quoted TOML string on one line.
std::string toml_string(const std::string& text);

}  // namespace prowl

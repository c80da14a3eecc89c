#pragma once

#include <string>

namespace prowl {

/// `text` as a TOML string on one line, with its quotes, by toml++.
std::string toml_string(const std::string& text);

}  // namespace prowl

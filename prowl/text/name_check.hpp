#pragma once

#include <string>

namespace prowl {

/// Whether files may use `name` for a joint, link, contact, phase and so on: printable ASCII without the comma,
/// quotation marks and the backslash, and no space at either end. Such a name stays one cell of a CSV file, one line of
/// a message, and a key of TOML and JSON.
bool is_name(const std::string& name);

/// What is_name asks for, in words: "letters, digits and ...".
extern const char* const kNameRule;

}  // namespace prowl

#pragma once

// Internal: includes toml++.
#include <toml++/toml.h>

#include <string>

namespace prowl {

/// Sets the value at a path such as "goal[0].base_displacement_m[2]" to a TOML text. A key at the end may be new; what
/// is before it must be there. Throws InputError that says which part is missing.
void set_at(toml::table& root, const std::string& path, const std::string& value);

/// A number that reads back as the same double.
std::string toml_number(double number);

/// The value of "value = TEXT".
toml::table parsed_value(const std::string& text);

/// Text of a document, the same for the same content.
std::string toml_text(const toml::table& root);

}  // namespace prowl

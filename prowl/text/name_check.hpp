#pragma once

#include <string>

namespace prowl {

/// True if `name` may name a joint, link, contact, phase etc.: see kNameRule. Such a name fits into
/// one CSV cell, one line of a message, and a TOML or JSON key.
bool is_name(const std::string& name);

/// Rule of is_name() in words, for messages.
extern const char* const kNameRule;

}  // namespace prowl

#pragma once

#include <string>

namespace prowl {

/// Throws InputError "name: value is not allowed; need ..." unless the value is allowed.
void check_option(bool is_allowed, const std::string& name, double value, const std::string& needed);

}  // namespace prowl

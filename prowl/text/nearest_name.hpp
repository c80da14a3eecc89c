#pragma once

#include <string>
#include <vector>

namespace prowl {

/// The name with the fewest changed, missing, added or swapped letters, ignoring case; "" without
/// names, or if `wrong` is longer than 200 bytes.
std::string nearest_name(const std::string& wrong, const std::vector<std::string>& names);

/// "; did you mean 'x'?" for the end of a message; "" without names.
std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& names);

}  // namespace prowl

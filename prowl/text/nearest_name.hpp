#pragma once

#include <string>
#include <vector>

namespace prowl {

/// The name that takes the fewest changed, missing, added or swapped letters (upper and lower case count as one) from
/// `wrong`; empty if there are no names, or `wrong` is longer than any name may be.
std::string nearest_name(const std::string& wrong, const std::vector<std::string>& names);

/// "; did you mean 'x'?" for the end of a message, or empty if there are no names.
std::string did_you_mean(const std::string& wrong, const std::vector<std::string>& names);

}  // namespace prowl

#pragma once

#include <optional>
#include <string>

namespace prowl {

/// Why Prowl, built with one release of a library, must not use the one that is loaded, with the remedy; nothing if it
/// may. Classes of C++ are laid out the same within a release ("3.14" of "3.14.19") and not between two.
std::optional<std::string> why_other_release(const std::string& library, const std::string& loaded,
                                             const std::string& built, const std::string& file);

/// Why a library cannot run on this processor; nothing if it can. `needs` and `has`: instruction sets with blanks
/// between, "AVX2 FMA".
std::optional<std::string> why_missing_instructions(const std::string& library, const std::string& needs,
                                                    const std::string& has);

}  // namespace prowl

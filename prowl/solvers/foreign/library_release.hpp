#pragma once

#include <optional>
#include <string>

namespace prowl {

/// Why Prowl must not use a loaded library of another release than that of the build, with the
/// remedy; nullopt if it may. The C++ ABI is stable only within a release ("3.14" of "3.14.19").
std::optional<std::string> why_other_release(const std::string& library, const std::string& loaded,
                                             const std::string& built, const std::string& file);

/// Why a library cannot run on this processor; nullopt if it can. `needs`, `has`: instruction sets
/// separated by blanks, "AVX2 FMA".
std::optional<std::string> why_missing_instructions(const std::string& library, const std::string& needs,
                                                    const std::string& has);

}  // namespace prowl

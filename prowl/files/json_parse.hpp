#pragma once

// Reads JSON that anybody may have written. Not installed: shows nlohmann's library.
#include <nlohmann/json.hpp>

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Throws InputError "file:line:column: ..." for what is not JSON, and "file: ..." for what would not fit: nlohmann's
/// library takes any depth, and looks for a key of an ordered object one by one.
nlohmann::ordered_json parse_json(const SourceText& source);

constexpr int kDeepestJson = 32;          ///< plan.json has 6
constexpr int kMostJsonKeys = 200;        ///< of one object, whose keys are compared with each other; plan.json has 20
constexpr int kMostJsonValues = 2000000;  ///< in all, 16 bytes and more each; plan.json has 6 a mesh interval

}  // namespace prowl

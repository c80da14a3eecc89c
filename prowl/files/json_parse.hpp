#pragma once

// Reads untrusted JSON. Not installed: shows nlohmann's library.
#include <nlohmann/json.hpp>

#include "prowl/files/text_file.hpp"

namespace prowl {

/// Throws InputError "file:line:column: ..." for invalid JSON and "file: ..." beyond the limits below: nlohmann's
/// library takes any depth and searches the keys of an ordered object one by one.
nlohmann::ordered_json parse_json(const SourceText& source);

constexpr int kDeepestJson = 32;          ///< plan.json has 6
constexpr int kMostJsonKeys = 200;        ///< per object, as keys are compared with each other; plan.json has 20
constexpr int kMostJsonValues = 2000000;  ///< in all, at least 16 bytes each; plan.json has 6 per mesh interval

}  // namespace prowl

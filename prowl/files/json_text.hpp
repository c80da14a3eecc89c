#pragma once

// Writes JSON as text. Not installed: shows nlohmann's library.
#include <nlohmann/json.hpp>
#include <string>

namespace prowl {

/// Indented, with a line end. Bytes that are not UTF-8 (from file names) become U+FFFD; dump() alone would throw.
inline std::string json_text(const nlohmann::ordered_json& json) {
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

/// `text` as it comes back from a JSON file.
inline std::string as_utf8(const std::string& text) {
  return nlohmann::ordered_json::parse(json_text(text)).get<std::string>();
}

}  // namespace prowl

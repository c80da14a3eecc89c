#include "prowl/report_page/page_template.hpp"

#include <fmt/format.h>

#include <string_view>

#include "prowl/error.hpp"

namespace prowl {
namespace {

constexpr const char* kPlaceholder = "PROWL_REPORT_DATA";
// A report file may load nothing; a served page may connect to its server.
constexpr const char* kPolicy = "default-src 'none';";
constexpr const char* kServedPolicy = "default-src 'none'; connect-src 'self';";

/// `page` with `data` in place of the placeholder. In JSON '<' occurs only inside strings; written
/// as \u003c it cannot close the script element or open another.
std::string filled(const std::string& page, const std::string& data) {
  const std::size_t index = page.find(kPlaceholder);
  if (index == std::string::npos || page.find(kPlaceholder, index + 1) != std::string::npos) {
    throw FileError(fmt::format("the template of the report is invalid: need {} in it exactly once", kPlaceholder));
  }
  std::string safe;
  safe.reserve(data.size());
  for (const char c : data) c == '<' ? safe += "\\u003c" : safe += c;
  return page.substr(0, index) + safe + page.substr(index + std::string_view(kPlaceholder).size());
}

/// The page with a content security policy that allows connections to its server.
std::string served(std::string page) {
  const std::size_t index = page.find(kPolicy);
  if (index == std::string::npos)
    throw FileError(fmt::format("the template of the report is invalid: need {} in it", kPolicy));
  return page.replace(index, std::string_view(kPolicy).size(), kServedPolicy);
}

}  // namespace

std::string filled_page(const std::string& page, const std::string& json, bool is_served) {
  return filled(is_served ? served(page) : page, json);
}

}  // namespace prowl

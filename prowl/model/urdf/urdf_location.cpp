#include "prowl/model/urdf/urdf_location.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>

#include "prowl/error.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

using tinyxml2::XMLElement;

namespace {

bool parse_number(std::string text, double& value) {
  const auto is_space = [](unsigned char c) { return std::isspace(c) != 0; };
  text.erase(text.begin(), std::find_if_not(text.begin(), text.end(), is_space));
  while (!text.empty() && is_space(static_cast<unsigned char>(text.back()))) text.pop_back();
  if (text.starts_with('+')) text.erase(0, 1);
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc{} && end == text.data() + text.size() && std::isfinite(value);
}

}  // namespace

void UrdfLocation::refuse(const XMLElement& at, const std::string& problem) const {
  throw InputError(fmt::format("{}:{}: {}: {}", file, at.GetLineNum(), element, problem));
}

std::string urdf_text(const UrdfLocation& location, const XMLElement& at, const char* name) {
  const char* text = at.Attribute(name);
  if (text == nullptr || *text == '\0')
    location.refuse(at, fmt::format("<{}> has no {}=\"...\"", shown(at.Name()), name));
  return text;
}

double urdf_number(const UrdfLocation& location, const XMLElement& at, const char* name, double largest) {
  const std::string text = urdf_text(location, at, name);
  double value = 0.0;
  if (!parse_number(text, value) || std::abs(value) > largest) {
    location.refuse(at,
                    fmt::format("<{} {}=\"{}\">: expected one finite number like 1.5 (SI units, no unit in the text)",
                                at.Name(), name, shown(text)));
  }
  return value;
}

double check_urdf_vector(const UrdfLocation& location, const XMLElement* at, const char* name, int size) {
  if (at == nullptr || at->Attribute(name) == nullptr) return 0.0;
  std::istringstream words(at->Attribute(name));
  std::string word;
  int count = 0;
  double largest = 0.0, value = 0.0;
  for (; count <= size && words >> word; ++count) {
    if (!parse_number(word, value) || std::abs(value) > kLargestInUrdf) break;
    largest = std::max(largest, std::abs(value));
  }
  if (words || count != size) {
    location.refuse(
        *at, fmt::format("<{} {}=\"{}\">: expected {}", at->Name(), name, shown(at->Attribute(name)),
                         size == 3 ? "three finite numbers like 0 0 1.5" : "four finite numbers like 0.5 0.5 0.5 1"));
  }
  return largest;
}

void check_urdf_origin(const UrdfLocation& location, const XMLElement& parent) {
  check_urdf_vector(location, parent.FirstChildElement("origin"), "xyz");
  check_urdf_vector(location, parent.FirstChildElement("origin"), "rpy");
}

}  // namespace prowl

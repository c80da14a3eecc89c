#include "prowl/batch/key_path.hpp"

#include <fmt/format.h>

#include <regex>
#include <sstream>

#include "prowl/error.hpp"

namespace prowl {

namespace {

/// What toml::at_path() takes for a path, with one text for each place.
bool is_path(const std::string& text) {
  constexpr std::size_t kLongest = 300;  // the expression is recursive
  static const std::regex path(R"([^.\[\]]+(\[(0|[1-9][0-9]{0,5})\])*(\.[^.\[\]]+(\[(0|[1-9][0-9]{0,5})\])*)*)");
  return text.size() <= kLongest && std::regex_match(text, path);
}

void need(const toml::table& root, const std::string& path) {
  if (!toml::at_path(root, path)) throw InputError(fmt::format("the task has no {}", path));
}

}  // namespace

toml::table parsed_value(const std::string& text) { return toml::parse("value = " + text); }

void set_at(toml::table& root, const std::string& path, const std::string& value) {
  constexpr const char* kEnds = ".[";  // of a part of the path
  if (!is_path(path)) {
    throw InputError(fmt::format("\"{}\" is no path of keys; need one such as \"goal[0].time_s\"", path));
  }
  for (std::size_t end = path.find_first_of(kEnds); end != std::string::npos;
       end = path.find_first_of(kEnds, end + 1)) {
    need(root, path.substr(0, end));
  }
  const std::size_t last = path.find_last_of(kEnds);
  const std::string before = last == std::string::npos ? "" : path.substr(0, last);
  toml::node& parent = before.empty() ? root : *toml::at_path(root, before).node();
  const toml::table parsed = parsed_value(value);
  parsed.get("value")->visit([&](const auto& of_type) {
    if (!before.empty() && path[last] == '[') {
      need(root, path);
      toml::array& list = *parent.as_array();
      list.replace(list.cbegin() + std::stol(path.substr(last + 1)), of_type);
    } else {
      if (!parent.is_table()) throw InputError(fmt::format("the task's {} has no keys", before));
      parent.as_table()->insert_or_assign(before.empty() ? path : path.substr(last + 1), of_type);
    }
  });
}

std::string toml_number(double number) {
  std::string text = fmt::format("{}", number);  // the shortest that reads back as the same
  if (text.find_first_of(".en") == std::string::npos) text += ".0";
  return text;
}

std::string toml_text(const toml::table& root) {
  std::ostringstream text;
  text << toml::toml_formatter(root) << "\n";
  return text.str();
}

}  // namespace prowl

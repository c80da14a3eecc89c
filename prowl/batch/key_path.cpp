#include "prowl/batch/key_path.hpp"

#include <fmt/format.h>

#include <cmath>
#include <sstream>
#include <variant>
#include <vector>

#include "prowl/error.hpp"

namespace prowl {

namespace {

/// A key of a table, or an index into a list.
using Step = std::variant<std::string, std::size_t>;

[[noreturn]] void refuse_path(const std::string& path) {
  throw InputError(fmt::format("\"{}\" is no path of keys; need one such as \"goal[0].time_s\"", path));
}

std::vector<Step> steps_of(const std::string& path) {
  std::vector<Step> steps;
  for (std::size_t at = 0; at < path.size();) {
    if (path[at] == '[') {
      const std::size_t end = path.find(']', at);
      const std::string digits = end == std::string::npos ? "" : path.substr(at + 1, end - at - 1);
      constexpr std::size_t kMostDigits = 6;
      const bool has_zeros = digits.size() > 1 && digits.front() == '0';  // two texts for one place
      if (digits.empty() || has_zeros || digits.size() > kMostDigits ||
          digits.find_first_not_of("0123456789") != std::string::npos) {
        refuse_path(path);
      }
      steps.emplace_back(static_cast<std::size_t>(std::stoul(digits)));
      at = end + 1;
      if (at < path.size() && path[at] != '[' && path[at] != '.') refuse_path(path);
      continue;
    }
    if (path[at] == '.') ++at;
    const std::size_t end = std::min(path.find_first_of(".[", at), path.size());
    if (end == at) refuse_path(path);
    steps.emplace_back(path.substr(at, end - at));
    at = end;
  }
  if (steps.empty()) refuse_path(path);
  return steps;
}

std::string text_of(const Step& step, const std::string& before) {
  if (const auto* index = std::get_if<std::size_t>(&step)) return fmt::format("{}[{}]", before, *index);
  return (before.empty() ? "" : before + ".") + std::get<std::string>(step);
}

toml::node* member(toml::node& node, const Step& step) {
  if (const auto* index = std::get_if<std::size_t>(&step))
    return node.is_array() ? node.as_array()->get(*index) : nullptr;
  return node.is_table() ? node.as_table()->get(std::get<std::string>(step)) : nullptr;
}

}  // namespace

toml::table parsed_value(const std::string& text) { return toml::parse("value = " + text); }

void set_at(toml::table& root, const std::string& path, const std::string& value) {
  const std::vector<Step> steps = steps_of(path);
  toml::node* node = &root;
  std::string walked;
  for (std::size_t i = 0; i + 1 < steps.size(); ++i) {
    const std::string next = text_of(steps[i], walked);
    node = member(*node, steps[i]);
    if (!node) throw InputError(fmt::format("the task has no {}", next));
    walked = next;
  }
  const toml::table parsed = parsed_value(value);
  const toml::node& new_value = *parsed.get("value");
  if (const auto* key = std::get_if<std::string>(&steps.back())) {
    if (!node->is_table()) throw InputError(fmt::format("the task's {} has no keys", walked));
    new_value.visit([&](const auto& of_type) { node->as_table()->insert_or_assign(*key, of_type); });
    return;
  }
  const std::size_t index = std::get<std::size_t>(steps.back());
  toml::array* const list = node->as_array();
  if (!list || index >= list->size())
    throw InputError(fmt::format("the task has no {}", text_of(steps.back(), walked)));
  new_value.visit(
      [&](const auto& of_type) { list->replace(list->cbegin() + static_cast<std::ptrdiff_t>(index), of_type); });
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

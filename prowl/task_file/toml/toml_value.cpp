#include "prowl/task_file/toml/toml_value.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "prowl/error.hpp"
#include "prowl/task_file/toml/toml_shape.hpp"
#include "prowl/text/name_check.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {
namespace {

std::string at(const SourceText& source, const toml::source_region& region) {
  return fmt::format("{}:{}:{}: ", source.path.string(), region.begin.line, region.begin.column);
}

/// Value as the user wrote it, for messages.
std::string describe(const toml::node& node) {
  if (const auto* text = node.as_string()) return fmt::format("\"{}\"", shown(text->get()));
  if (const auto* number = node.as_integer()) return fmt::format("{}", number->get());
  if (const auto* number = node.as_floating_point()) return fmt::format("{:g}", number->get());
  if (const auto* flag = node.as_boolean()) return flag->get() ? "true" : "false";
  if (const auto* list = node.as_array()) return fmt::format("a list of {}", list->size());
  if (node.is_table()) return "a table";
  return "a date or time";
}

std::string join_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : fmt::format("{}.{}", path, key);
}

std::string unknown(const std::string& what, const std::string& name, const std::vector<std::string>& known) {
  return fmt::format("unknown {}{} Known: {}", what, did_you_mean(name, known), fmt::join(known, ", "));
}

/// " It is a key of [phase]." for a key of other tables, else "".
std::string where_else(const FileKeys& keys, const std::string& name) {
  std::vector<std::string> tables;
  for (const FileKey& key : keys) {
    if (key.name == name) tables.push_back(key.table.empty() ? "the top of the file" : fmt::format("[{}]", key.table));
  }
  return tables.empty() ? "" : fmt::format(" It is a key of {}.", fmt::join(tables, ", "));
}

/// "a finite number > 0", "a number from 1 to 10".
std::string in_words(const NumberRange& range) {
  const std::string limits = range.limits();
  if (limits.empty()) return "a finite number";
  return fmt::format("a {}number {}", std::isfinite(range.lower) && std::isfinite(range.upper) ? "" : "finite ",
                     limits);
}

/// Location of a key (`with_key`) or its value; if missing, of the innermost table around it.
std::optional<std::string> location_of(const SourceText& source, const std::string& path, bool with_key) {
  const toml::table root = toml::parse(source.text);
  for (std::string rest = path; !rest.empty();) {
    const std::size_t end = rest.find_last_of(".[");
    const std::string parent = rest.substr(0, end == std::string::npos ? 0 : end);
    if (const auto node = toml::at_path(root, rest)) {
      const bool is_member = end == std::string::npos || rest[end] == '.';
      const toml::table* const table = parent.empty() ? &root : toml::at_path(root, parent).as_table();
      if (with_key && is_member && table)
        return at(source, table->find(rest.substr(parent.empty() ? 0 : end + 1))->first.source());
      return at(source, node.node()->source());
    }
    rest = parent;
  }
  return std::nullopt;
}

/// Reports a mistake at a key; throws it unless mistakes are collected.
void refuse_key(const TomlValue& table, const toml::key& key, const std::string& message) {
  const std::string text = fmt::format("{}{}: {}", at(table.source(), key.source()),
                                       join_path(table.path(), shown(std::string(key.str()))), message);
  if (!table.mistakes()) throw InputError(text);
  const toml::source_position begin = key.source().begin;
  table.mistakes()->add(static_cast<int>(begin.line), static_cast<int>(begin.column), text);
}

/// Checks the keys of a table and of its declared subtables.
void check_keys(const TomlValue& value, const FileKeys& keys, const std::string& declared) {
  if (value.is_list()) {
    for (const TomlValue& entry : value.as_list()) check_keys(entry, keys, declared);
  }
  if (!value.is_table()) return;
  const TomlTable table(value, keys, declared);
  for (const auto& [key, node] : *value.node().as_table()) {
    const std::string name(key.str()), below = join_path(declared, name);
    if (std::ranges::none_of(keys, [&below](const FileKey& known) { return known.table == below; })) continue;
    check_keys(*table.find(name), keys, below);
  }
}

}  // namespace

void Mistakes::add(int line, int column, const std::string& message) {
  std::vector<std::string>& here = found_[{line, column}];
  if (std::ranges::find(here, message) != here.end()) return;
  here.push_back(message);
  ++count_;
}

void Mistakes::raise() const {
  constexpr std::size_t kMost = 10;  // shown at once
  std::string text;
  std::size_t count = 0;
  for (const auto& [position, messages] : found_) {
    for (const std::string& message : messages) {
      if (count++ < kMost) text += (text.empty() ? "" : "\n") + message;
    }
  }
  if (count > kMost) text += fmt::format("\nand {}{} more", is_full() ? "at least " : "", count - kMost);
  if (count > 0) throw InputError(text);
}

const FileKey& TomlValue::key() const {
  assert(key_ != nullptr);
  return *key_;
}

std::string TomlValue::located(const std::string& message) const {
  return fmt::format("{}{}{}{}", at(*source_, node_->source()), path_, path_.empty() ? "" : ": ", message);
}

void TomlValue::fail(const std::string& message) const { throw InputError(located(message)); }

void TomlValue::refuse(const std::string& message) const {
  if (!mistakes_) fail(message);
  const toml::source_position begin = node_->source().begin;
  mistakes_->add(static_cast<int>(begin.line), static_cast<int>(begin.column), located(message));
}

void TomlValue::fail_mistake(const std::string& message) const {
  refuse(message);
  fail(message);
}

std::string TomlValue::not_allowed(const std::string& needed, const std::string& hint) const {
  const bool has_unit = key_ != nullptr && !key_->unit.empty() && key_->unit != "-";
  const std::string unit = has_unit ? fmt::format(" [{}]", key_->unit) : "";
  return fmt::format("{} is not allowed; need {}{}{}", describe(*node_), needed, unit, hint);
}

void TomlValue::refuse_type(const std::string& needed, const std::string& hint) const {
  refuse(not_allowed(needed, hint));
}

void TomlValue::fail_unknown_name(const std::string& what, const std::vector<std::string>& known) const {
  fail_mistake(unknown(fmt::format("{} {}", what, describe(*node_)), node_->value_or<std::string>(""), known));
}

void TomlValue::fail_type(const std::string& needed, const std::string& hint) const {
  fail_mistake(not_allowed(needed, hint));
}

double TomlValue::as_number(const NumberRange& range) const {
  const double value = node_->is_number() ? node_->value_or(std::numeric_limits<double>::quiet_NaN()) : 0.0;
  if (!node_->is_number()) {
    refuse_type(in_words(range));
  } else if (std::isfinite(value) && std::abs(value) > NumberRange::kLargest) {
    refuse(fmt::format("{:g} is not allowed; need a number of at most {:g} in size", value, NumberRange::kLargest));
  } else if (!range.contains(value)) {
    refuse_type(in_words(range), range.hint);
  } else {
    return value;
  }
  return range.any_inside();
}

int TomlValue::as_integer() const {
  const auto* integer = node_->as_integer();
  // NumberRange::kLargest fits into an int.
  if (!integer || !key().range.contains(static_cast<double>(integer->get()))) {
    refuse_type("an integer " + key().range.limits(), node_->is_floating_point() ? ", without a point" : "");
    return static_cast<int>(key().range.any_inside());
  }
  return static_cast<int>(integer->get());
}

bool TomlValue::as_boolean() const {
  const auto* flag = node_->as_boolean();
  if (!flag) refuse_type("true or false");
  return flag && flag->get();
}

std::string TomlValue::as_text() const {
  const auto* text = node_->as_string();
  if (!text || text->get().empty()) fail_type("a non-empty string in quotes");
  return text->get();
}

std::string TomlValue::as_name() const {
  if (const std::string name = as_text(); is_name(name)) return name;
  fail(fmt::format("this name is not allowed; need {}", kNameRule));
}

std::vector<TomlValue> TomlValue::as_list() const {
  const auto* list = node_->as_array();
  if (!list) fail_type("a list in [ ]");
  constexpr std::size_t kMost = 10000;  // corners, points or contacts; more are a mistake, and need gigabytes of memory
  if (list->size() > kMost) fail(fmt::format("a list of {} is not allowed; need at most {}", list->size(), kMost));
  std::vector<TomlValue> values;
  for (std::size_t i = 0; i < list->size(); ++i) {
    values.emplace_back(*source_, (*list)[i], fmt::format("{}[{}]", path_, i), key_, mistakes_);
  }
  return values;
}

std::vector<TomlValue> TomlValue::as_list(std::size_t size) const {
  if (!is_list() || node_->as_array()->size() != size) fail_type(fmt::format("a list of {}", size));
  return as_list();
}

Eigen::Vector3d TomlValue::as_vector3() const {
  if (!is_list() || node_->as_array()->size() != 3) {
    refuse_type("a list of 3");
    return Eigen::Vector3d::UnitZ();
  }
  const std::vector<TomlValue> entries = as_list(3);
  return {entries[0].as_number(), entries[1].as_number(), entries[2].as_number()};
}

TomlBounds TomlValue::as_bounds() const {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (is_text() && node_->as_string()->get() == "free") return {-kInfinity, kInfinity};
  if (is_list()) {
    const std::vector<TomlValue> ends = as_list(2);
    const TomlBounds bounds{ends[0].as_number(), ends[1].as_number()};
    if (bounds.lower > bounds.upper) {
      refuse(fmt::format("[{:g}, {:g}] is not allowed; need [min, max] with min <= max", bounds.lower, bounds.upper));
      return {bounds.upper, bounds.lower};
    }
    return bounds;
  }
  if (!node_->is_number()) {
    refuse_type("a finite number, [min, max] or \"free\"");
    return {-kInfinity, kInfinity};
  }
  const double value = as_number();
  return {value, value};
}

TomlBounds TomlValue::as_one_sided_bounds() const {
  if (!is_list()) return as_bounds();
  const std::vector<TomlValue> ends = as_list(2);
  const auto is_free = [](const TomlValue& end) { return end.is_text() && end.as_text() == "free"; };
  if (is_free(ends[0])) return {-std::numeric_limits<double>::infinity(), ends[1].as_number()};
  if (is_free(ends[1])) return {ends[0].as_number(), std::numeric_limits<double>::infinity()};
  return as_bounds();
}

TomlBounds TomlValue::as_range() const {
  if (!is_list()) {
    const double value = as_number();
    return {value, value};
  }
  const std::vector<TomlValue> ends = as_list(2);
  const TomlBounds bounds{ends[0].as_number(), ends[1].as_number()};
  if (bounds.lower > bounds.upper) {
    refuse("min > max is not allowed; need [min, max]");
    return {bounds.upper, bounds.lower};
  }
  return bounds;
}

std::size_t TomlValue::as_one_of(const std::string& what, const std::vector<std::string>& known) const {
  const auto found = std::find(known.begin(), known.end(), as_text());
  if (found == known.end()) {
    if (!mistakes_ || known.empty()) fail_unknown_name(what, known);
    refuse(unknown(fmt::format("{} {}", what, describe(*node_)), as_text(), known));
    return 0;
  }
  return static_cast<std::size_t>(found - known.begin());
}

std::vector<std::pair<std::string, TomlValue>> TomlValue::as_free_named_values(const std::string& what) const {
  const auto* table = node_->as_table();
  if (!table) fail_type(fmt::format("a table {{{} = ...}}", what));
  std::vector<std::pair<std::string, TomlValue>> values;
  for (const auto& [key, node] : *table) {
    const std::string name(key.str());
    values.emplace_back(name, TomlValue(*source_, node, join_path(path_, shown(name)), key_, mistakes_));
  }
  return values;
}

std::vector<std::pair<std::string, TomlValue>> TomlValue::as_named_values(const std::vector<std::string>& known,
                                                                          const std::string& what) const {
  const auto is_known = [&known](const std::string& name) { return std::ranges::find(known, name) != known.end(); };
  std::vector<std::pair<std::string, TomlValue>> values = as_free_named_values(what);
  for (const auto& [key, node] : *node_->as_table()) {
    if (mistakes_ && mistakes_->is_full()) break;
    const std::string name(key.str());
    if (!is_known(name)) refuse_key(*this, key, unknown(what, name, known));
  }
  std::erase_if(values, [&is_known](const auto& value) { return !is_known(value.first); });
  return values;
}

TomlTable::TomlTable(const TomlValue& value, const FileKeys& keys, const std::string& declared)
    : value_(value), keys_(&keys), declared_(declared) {
  const std::vector<std::string> names = key_names(keys, declared);
  if (!value.is_table())
    value.fail_mistake(
        fmt::format("{} is not allowed; need a table with {}", describe(value.node()), fmt::join(names, ", ")));
  for (const auto& [key, node] : *value.node().as_table()) {
    const std::string name(key.str());
    if (std::find(names.begin(), names.end(), name) != names.end()) continue;
    if (value.mistakes() && value.mistakes()->is_full()) break;
    refuse_key(value, key,
               fmt::format("unknown key{}{} Known: {}", did_you_mean(name, names), where_else(keys, name),
                           fmt::join(names, ", ")));
  }
}

std::string TomlTable::path_of(const std::string& key) const { return join_path(value_.path(), key); }

std::optional<TomlValue> TomlTable::find(const std::string& key) const {
  const toml::node* node = table().get(key);
  if (!node) return std::nullopt;
  return TomlValue(value_.source(), *node, path_of(key), &file_key(*keys_, declared_, key), value_.mistakes());
}

bool TomlTable::has_unknown_key() const {
  const std::vector<std::string> names = key_names(*keys_, declared_);
  return std::ranges::any_of(table(), [&names](const auto& entry) {
    return std::ranges::find(names, std::string(entry.first.str())) == names.end();
  });
}

std::optional<TomlValue> TomlTable::find_misspelt(const std::string& key) const {
  const std::vector<std::string> names = key_names(*keys_, declared_);
  for (const auto& [wrong, node] : table()) {
    const std::string name(wrong.str());
    if (std::ranges::find(names, name) == names.end() && nearest_name(name, names) == key)
      return TomlValue(value_.source(), node, path_of(key), &file_key(*keys_, declared_, key), value_.mistakes());
  }
  return std::nullopt;
}

TomlValue TomlTable::need(const std::string& key) const {
  if (auto value = find(key)) return *value;
  if (value_.mistakes()) {
    if (auto value = find_misspelt(key)) return *value;
  }
  const FileKey& declared = file_key(*keys_, declared_, key);
  const TomlValue missing(value_.source(), value_.node(), path_of(key), &declared, value_.mistakes());
  const std::string message = fmt::format("missing; need {}: {}", declared.value(), declared.meaning);
  if (value_.mistakes() && has_unknown_key()) missing.fail(message);  // an unknown key may be this one, misspelt
  missing.fail_mistake(message);
}

std::optional<TomlTable> TomlTable::find_table(const std::string& key) const {
  const auto value = find(key);
  if (!value) return std::nullopt;
  return TomlTable(*value, *keys_, declared_.empty() ? key : declared_ + "." + key);
}

std::vector<TomlTable> TomlTable::find_tables(const std::string& key, std::size_t most) const {
  const auto value = find(key);
  if (!value) return {};
  const std::string declared = declared_.empty() ? key : declared_ + "." + key;
  if (!value->is_list()) {
    value->fail(fmt::format("{} is not allowed; need one [[{}]] for each", describe(value->node()), declared));
  }
  if (const std::size_t size = value->node().as_array()->size(); size > most) {
    value->fail(fmt::format("{} [[{}]] are not allowed; need at most {}", size, declared, most));
  }
  std::vector<TomlTable> tables;
  for (const TomlValue& entry : value->as_list()) tables.emplace_back(entry, *keys_, declared);
  return tables;
}

TomlDocument::TomlDocument(const SourceText& source) : source_(source) {
  if (const std::size_t first = source.text.find_first_not_of(" \t\r\n");
      first != std::string::npos && source.text[first] == '<') {
    throw InputError(fmt::format("{}:1:1: this looks like XML; need a TOML file (a URDF is named by a robot file)",
                                 source.path.string()));
  }
  check_toml_shape(source_);
  try {
    table_ = toml::parse(source_.text, source_.path.string());
  } catch (const toml::parse_error& error) {
    throw InputError(at(source_, error.source()) + std::string(error.description()));
  }
}

void TomlDocument::refuse_key(const std::string& key, const std::string& message) const {
  if (const toml::node* node = table_.get(key)) TomlValue(source_, *node, key, nullptr).fail(message);
}

TomlTable TomlDocument::root(const FileKeys& keys) const {
  return TomlTable(TomlValue(source_, table_, "", nullptr, &mistakes_), keys, "");
}

void TomlDocument::check_all_keys(const FileKeys& keys) const {
  check_keys(TomlValue(source_, table_, "", nullptr, &mistakes_), keys, "");
}

void TomlDocument::add_mistake(const std::string& message) const {
  mistakes_.add(std::numeric_limits<int>::max(), 0, message);  // sorted after those of this file
}

std::optional<std::string> find_location(const SourceText& source, const std::string& path) {
  return location_of(source, path, false);
}

std::string locate(const SourceText& source, const std::string& path) {
  return location_of(source, path, false).value_or(source.path.string() + ":1:1: ");
}

std::string locate_key(const SourceText& source, const std::string& path) {
  return location_of(source, path, true).value_or(source.path.string() + ":1:1: ");
}

}  // namespace prowl

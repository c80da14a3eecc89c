#include "prowl/task_file/problem_fields.hpp"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {
namespace {

/// Keys that may set a field of MotionProblem, likeliest first.
std::vector<std::string> keys_of(const std::string& field) {
  const auto rest_after = [&field](const std::string& prefix) { return field.substr(prefix.size()); };
  if (field.starts_with("boundary_constraints[0]")) return {"start", "phase[0].contacts", "gait"};
  if (const std::string prefix = "boundary_constraints["; field.starts_with(prefix)) {
    return {fmt::format("goal[{}]", std::stoi(rest_after(prefix)) - 1), "gait"};
  }
  const std::pair<const char*, const char*> kPrefixes[] = {
      {"phases[", "phase["}, {"surfaces[", "surface["}, {"terms[", "term["}, {"running_cost", "cost"}};
  const std::pair<std::string_view, const char*> kSuffixes[] = {
      {".foothold", ".place_m"}, {".duration", ".duration_s"}, {".point", ".point_m"}, {".patch", ".patch_m"}};
  std::string key = field;
  for (const auto& [prefix, in_file] : kPrefixes) {
    if (field.starts_with(prefix)) key = in_file + rest_after(prefix);
  }
  for (const auto& [suffix, in_file] : kSuffixes) {
    if (field.ends_with(suffix)) key.replace(key.size() - suffix.size(), suffix.size(), in_file);
  }
  if (field.starts_with("phases[")) return {key, "gait"};
  return {key};
}

}  // namespace

std::string in_terms_of_the_file(const SourceText& task_file, const std::string& complaint) {
  const std::string nowhere = locate(task_file, "");
  const std::size_t colon = complaint.find(": ");
  if (colon == std::string::npos) return nowhere + complaint;
  const std::string message = complaint.substr(colon);
  const std::vector<std::string> keys = keys_of(complaint.substr(0, colon));
  for (const std::string& key : keys) {
    if (const auto location = find_location(task_file, key)) return *location + key + message;
  }
  return nowhere + keys.front() + message;
}

}  // namespace prowl

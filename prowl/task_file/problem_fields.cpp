#include "prowl/task_file/problem_fields.hpp"

#include <fmt/format.h>

#include <vector>

#include "prowl/task_file/toml/toml_value.hpp"

namespace prowl {
namespace {

/// Keys that may set a field of MotionProblem, likeliest first.
std::vector<std::string> keys_of(const std::string& field) {
  const auto rest_after = [&field](const std::string& start) { return field.substr(start.size()); };
  if (field.starts_with("boundary_conditions[0]")) return {"start", "phase[0].contacts", "gait"};
  if (const std::string start = "boundary_conditions["; field.starts_with(start)) {
    return {fmt::format("goal[{}]", std::stoi(rest_after(start)) - 1), "gait"};
  }
  const std::pair<const char*, const char*> kStarts[] = {
      {"phases[", "phase["}, {"surfaces[", "surface["}, {"running_cost", "cost"}};
  const std::pair<const char*, const char*> kEnds[] = {
      {".place", "_m"}, {".duration", "_s"}, {".point", "_m"}, {".patch", "_m"}};
  std::string key = field;
  for (const auto& [start, in_file] : kStarts) {
    if (field.starts_with(start)) key = in_file + rest_after(start);
  }
  for (const auto& [end, unit] : kEnds) {
    if (field.ends_with(end)) key += unit;
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
    if (const auto place = find_place(task_file, key)) return *place + key + message;
  }
  return nowhere + keys.front() + message;
}

}  // namespace prowl

#include "json_result.hpp"

#include <algorithm>
#include <nlohmann/json.hpp>
#include <regex>
#include <string_view>

#include "exit_status.hpp"
#include "output.hpp"
#include "prowl/io/json_text.hpp"

namespace prowl::cli {
namespace {

using Json = nlohmann::ordered_json;

const char* kind_of(int exit_status) {
  switch (exit_status) {
    case kBadInput: return "input";
    case kFiles: return "files";
    case kNumericalFailure: return "numerical";
    case kInterrupted: return "interrupted";
    default: return "unexpected";
  }
}

Json error_to_json(int exit_status, const std::string& message) {
  Json error = {{"kind", kind_of(exit_status)}, {"message", message}};
  // "robots/hyq.toml:12:3: ...", as InputError has it.
  static const std::regex kPlace("^((?:(?!: )[^\n])*?):([0-9]{1,9}):([0-9]{1,9}): ");
  if (std::smatch place; std::regex_search(message, place, kPlace)) {
    error["file"] = place[1].str();
    error["line"] = std::stoi(place[2]);
    error["column"] = std::stoi(place[3]);
  }
  return error;
}

}  // namespace

void print_json(const JsonResult& result) {
  Json json = {{"verb", result.verb}, {"exit_status", result.exit_status}};
  if (result.plan) {
    json["directory"] = std::filesystem::absolute(result.directory).lexically_normal().string();
    json["name"] = result.plan->task.problem.name;
    json["robot"] = result.plan->task.problem.robot.name();
  }
  json["written"] = Json::array();
  for (const std::filesystem::path& path : result.written) json["written"].push_back(path.string());
  json.update(Json::parse(result.result));
  print_result(json_text(json));
}

void print_json_error(const std::string& verb, int exit_status, const std::string& message) noexcept {
  try {
    print_result(json_text({{"verb", verb}, {"exit_status", exit_status}, {"error", error_to_json(exit_status, message)}}));
  } catch (const std::exception&) {
  }
}

bool asks_for_json(int argc, const char* const* argv) {
  return std::any_of(argv, argv + argc, [](const char* argument) { return std::string_view(argument) == "--json"; });
}

}  // namespace prowl::cli

#include "cli/screen/json_result.hpp"

#include <algorithm>
#include <charconv>
#include <nlohmann/json.hpp>
#include <string_view>

#include "cli/process/exit_status.hpp"
#include "cli/screen/output.hpp"
#include "prowl/files/json_text.hpp"

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
  // "robots/hyq.toml:12:3: ...", as in InputError.
  const std::string location = message.substr(0, std::min(message.find(": "), message.find('\n')));
  const std::size_t before_column = location.rfind(':'),
                    before_line = location.rfind(':', before_column == 0 ? 0 : before_column - 1);
  if (before_column == std::string::npos || before_line == std::string::npos || before_line == before_column)
    return error;
  const auto number = [&location](std::size_t begin, std::size_t end) {
    int value = -1;
    const auto [last, problem] = std::from_chars(location.data() + begin, location.data() + end, value);
    return problem == std::errc() && last == location.data() + end ? value : -1;
  };
  const int line = number(before_line + 1, before_column), column = number(before_column + 1, location.size());
  if (line < 1 || column < 1) return error;
  error["file"] = location.substr(0, before_line);
  error["line"] = line;
  error["column"] = column;
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
  print_bytes(json_text(json));
}

void print_json_error(const std::string& verb, int exit_status, const std::string& message) noexcept {
  try {
    print_bytes(
        json_text({{"verb", verb}, {"exit_status", exit_status}, {"error", error_to_json(exit_status, message)}}));
  } catch (const std::exception&) {  // stdout is closed
  }
}

bool asks_for_json(int argc, const char* const* argv) {
  return std::any_of(argv, argv + argc, [](const char* argument) { return std::string_view(argument) == "--json"; });
}

}  // namespace prowl::cli

#include "prowl/files/json_parse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

#include "prowl/error.hpp"

namespace prowl {
namespace {

using Json = nlohmann::ordered_json;

/// Throws as soon as a limit is exceeded.
class Limits {
 public:
  explicit Limits(const SourceText& source) : file_(source.path.string()) {}

  bool operator()(int depth, Json::parse_event_t event, const Json&) {
    if (depth > kDeepestJson) fail("lists and objects", kDeepestJson, "deep");
    if (event == Json::parse_event_t::object_start) keys_[depth + 1] = 0;
    if (event == Json::parse_event_t::key && ++keys_[depth] > kMostJsonKeys)
      fail("keys", kMostJsonKeys, "in an object");
    if (event != Json::parse_event_t::key && ++values_ > kMostJsonValues) fail("values", kMostJsonValues, "in all");
    return true;
  }

 private:
  [[noreturn]] void fail(const char* what, int most, const char* where) const {
    throw InputError(fmt::format("{}: {} more than {} {} are not allowed; prowl does not write such files", file_, what,
                                 most, where));
  }

  std::string file_;
  std::array<int, kDeepestJson + 2> keys_{};  // of the object at each depth
  int values_ = 0;
};

}  // namespace

Json parse_json(const SourceText& source) {
  try {
    return Json::parse(source.text, Limits(source));
  } catch (const Json::parse_error& error) {
    const std::size_t at = std::max<std::size_t>(error.byte, 1) - 1;  // it counts from 1; 0 if unknown
    throw InputError(
        fmt::format("{}: not JSON from here on: the file is cut short or was edited", location_in(source, at)));
  } catch (const Json::out_of_range&) {
    throw InputError(fmt::format("{}: a number exceeds 1.8e308", source.path.string()));
  }
}

}  // namespace prowl

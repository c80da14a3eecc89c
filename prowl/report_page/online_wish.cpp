#include "prowl/report_page/online_wish.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

#include "prowl/error.hpp"

namespace prowl {

OnlineWish parse_wish(const std::string& text) {
  using Json = nlohmann::json;
  const Json json = Json::parse(text, nullptr, false);
  const auto number = [&](const char* key) {
    const auto found = json.find(key);
    if (found == json.end() || !found->is_number()) throw InputError(std::string(key) + ": need a number");
    return found->get<double>();
  };
  if (!json.is_object()) throw InputError("need a JSON object");
  OnlineWish wish;
  if (json.contains("kick")) {
    wish.kick = number("kick");
    constexpr double kMost = 5.0;  // [m/s]
    if (!(std::abs(*wish.kick) <= kMost)) throw InputError("kick: need at most 5 m/s");
  }
  if (json.contains("forward")) {
    TimedCommand& timed = wish.command.emplace();
    timed.command = {number("forward"), number("left"), number("turn"), number("height")};
    if (json.contains("gait") && json["gait"].is_string()) timed.gait = json["gait"].get<std::string>();
  }
  return wish;
}

}  // namespace prowl

#include "prowl/task_file/task_payload.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "prowl/model/robot_inspection.hpp"
#include "prowl/text/nearest_name.hpp"

namespace prowl {

RobotModel with_payloads(const TomlTable& root, RobotModel robot) {
  const std::vector<TomlTable> tables = root.find_tables("payload");
  if (tables.empty()) return robot;
  const std::vector<std::string> frames = contact_frame_names(robot);
  RobotDescription description = robot.description();
  for (const TomlTable& table : tables) {
    const TomlValue body = table.need("body");
    Payload payload{.body = body.as_text(), .mass = table.need("mass_kg").as_number()};
    if (std::ranges::find(frames, payload.body) == frames.end()) {
      body.fail(
          fmt::format("robot '{}' has no link '{}'{}", robot.name(), payload.body, did_you_mean(payload.body, frames)));
    }
    if (const auto center = table.find("com_m")) payload.center = center->as_vector3();
    description.payloads.push_back(std::move(payload));
  }
  return RobotModel(std::move(description));
}

}  // namespace prowl

#include "prowl/model/robot_frame.hpp"

#include <fmt/format.h>

#include <vector>

#include "prowl/error.hpp"
#include "prowl/model/pinocchio_model.hpp"
#include "prowl/text/nearest_name.hpp"
#include "prowl/text/shown_text.hpp"

namespace prowl {

RobotFrame robot_frame(const RobotModel& robot, const std::string& name) {
  const pinocchio::Model& model = robot.pinocchio().model;
  if (model.existFrame(name, pinocchio::BODY)) {
    const pinocchio::Frame& frame = model.frames[model.getFrameId(name, pinocchio::BODY)];
    RobotFrame result{.body = static_cast<int>(frame.parentJoint - kBaseJoint)};
    result.placement.linear() = frame.placement.rotation();
    result.placement.translation() = frame.placement.translation();
    return result;
  }
  if (name == kBaseFrame) return {};
  std::vector<std::string> names = {kBaseFrame};
  for (const pinocchio::Frame& frame : model.frames) {
    if (frame.type == pinocchio::BODY) names.push_back(frame.name);
  }
  throw InputError(fmt::format("robot '{}' has no link '{}'{}", robot.name(), shown(name), did_you_mean(name, names)));
}

}  // namespace prowl

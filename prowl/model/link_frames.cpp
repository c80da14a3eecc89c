#include "prowl/model/link_frames.hpp"

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

std::vector<LinkFrame> link_frames(const RobotModel& robot) {
  constexpr pinocchio::JointIndex kBaseJoint = 1;  // 0 is the world
  std::vector<LinkFrame> links;
  for (const pinocchio::Frame& frame : robot.pinocchio().model.frames) {
    if (frame.type != pinocchio::BODY || frame.parentJoint < kBaseJoint) continue;
    LinkFrame& link = links.emplace_back();
    link.name = frame.name;
    link.body = static_cast<int>(frame.parentJoint - kBaseJoint);
    link.placement.linear() = frame.placement.rotation();
    link.placement.translation() = frame.placement.translation();
  }
  return links;
}

}  // namespace prowl

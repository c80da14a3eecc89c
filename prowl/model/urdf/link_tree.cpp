#include "prowl/model/urdf/link_tree.hpp"

#include <map>

#include "prowl/model/pinocchio_model.hpp"

namespace prowl {

std::vector<RobotLink> link_tree(const RobotModel& robot) {
  const pinocchio::Model& model = robot.pinocchio().model;
  std::vector<RobotLink> links;
  std::map<pinocchio::FrameIndex, int> index;  // of the links so far, by their frame; a parent has a smaller number
  for (pinocchio::FrameIndex f = 0; f < model.frames.size(); ++f) {
    const pinocchio::Frame& frame = model.frames[f];
    if (frame.type != pinocchio::BODY || frame.parentJoint < kBaseJoint) continue;
    RobotLink& link = links.emplace_back();
    link.name = frame.name;
    link.body = static_cast<int>(frame.parentJoint - kBaseJoint);
    link.placement.linear() = frame.placement.rotation();
    link.placement.translation() = frame.placement.translation();
    // Between two links is the frame of the joint.
    for (pinocchio::FrameIndex above = frame.parentFrame; above != 0; above = model.frames[above].parentFrame) {
      const auto found = index.find(above);
      if (found == index.end()) continue;
      link.parent = found->second;
      link.fixed = links[link.parent].body == link.body;
      break;
    }
    index[f] = static_cast<int>(links.size()) - 1;
  }
  return links;
}

std::vector<Eigen::Isometry3d> link_placements(const std::vector<RobotLink>& links,
                                               const std::vector<Eigen::Isometry3d>& bodies) {
  std::vector<Eigen::Isometry3d> placements;
  for (const RobotLink& link : links) placements.push_back(bodies[link.body] * link.placement);
  return placements;
}

}  // namespace prowl

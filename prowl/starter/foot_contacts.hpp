#pragma once

#include <string>
#include <vector>

#include "prowl/starter/foot_shapes.hpp"
#include "prowl/starter/legs.hpp"
#include "prowl/starter/robot_pose.hpp"

namespace prowl {

/// Contacts of one foot and their origin.
struct FootContacts {
  std::vector<ContactPoint> contacts;
  std::string how;  ///< origin on one line, for a comment
};

/// Contacts of a foot with the ground below it in this pose:
///
/// - its lowest spheres, one contact each;
/// - else, on a leg of five joints or more, the corners of a rectangle inside its flat sole;
/// - else a ball around the frame above its lowest point, or that point itself.
///
/// The sole need not be level in this pose: the link axis closest to down counts as down, if within
/// 20 degrees.
FootContacts foot_contacts(const RobotPose& pose, const Leg& leg, const FootShapes& shapes);

}  // namespace prowl

#pragma once

#include <string>
#include <vector>

#include "prowl/starter/foot_shapes.hpp"
#include "prowl/starter/legs.hpp"
#include "prowl/starter/robot_pose.hpp"

namespace prowl {

/// The contacts of one foot, and where they come from.
struct FootContacts {
  std::vector<ContactPoint> contacts;
  std::string how;  ///< one line, for a comment
};

/// What of the foot touches the ground below it in this pose:
///
/// - its lowest spheres, one contact each;
/// - else, on a leg of five joints or more, the corners of a rectangle inside its flat sole;
/// - else a ball around the frame that its lowest point lies below; or that point itself.
///
/// A sole need not be level in this pose: of the axes of the foot's links, the one that points most nearly down is
/// taken for down if it is within 20 degrees of it.
FootContacts foot_contacts(const RobotPose& pose, const Leg& leg, const FootShapes& shapes);

}  // namespace prowl

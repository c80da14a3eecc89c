// STUB, not ROS 2: what examples/ros2_control uses of it.
#pragma once

namespace rclcpp_lifecycle {
class State {};
}  // namespace rclcpp_lifecycle

// STUB, not ROS 2: what examples/ros2_control uses of it.
#pragma once

namespace rclcpp {
class Duration {};
class Time {
 public:
  double seconds() const { return seconds_; }

 private:
  double seconds_ = 0.0;
};
}  // namespace rclcpp

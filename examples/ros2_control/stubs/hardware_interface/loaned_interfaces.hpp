// STUB, not ROS 2: what examples/ros2_control uses of it.
#pragma once

#include <optional>

namespace hardware_interface {
class LoanedStateInterface {
 public:
  std::optional<double> get_optional() const { return value_; }

 private:
  double value_ = 0.0;
};
class LoanedCommandInterface {
 public:
  bool set_value(double value) {
    value_ = value;
    return true;
  }

 private:
  double value_ = 0.0;
};
}  // namespace hardware_interface

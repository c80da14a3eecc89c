// STUB, not ROS 2: what examples/ros2_control uses of it.
#pragma once

#include <hardware_interface/loaned_interfaces.hpp>
#include <memory>
#include <rclcpp/time.hpp>
#include <rclcpp_lifecycle/state.hpp>
#include <string>
#include <vector>

namespace controller_interface {

enum class return_type { OK, ERROR };
enum class CallbackReturn { SUCCESS, FAILURE, ERROR };
enum class interface_configuration_type { ALL, INDIVIDUAL, NONE };
struct InterfaceConfiguration {
  interface_configuration_type type;
  std::vector<std::string> names;
};

struct Parameter {
  std::string value;
  std::string as_string() const { return value; }
};
struct Node {
  void declare_parameter(const std::string&, const std::string&) {}
  Parameter get_parameter(const std::string&) const { return {}; }
};

class ControllerInterface {
 public:
  virtual ~ControllerInterface() = default;
  virtual CallbackReturn on_init() = 0;
  virtual CallbackReturn on_configure(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_activate(const rclcpp_lifecycle::State&) = 0;
  virtual CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) = 0;
  virtual InterfaceConfiguration command_interface_configuration() const = 0;
  virtual InterfaceConfiguration state_interface_configuration() const = 0;
  virtual return_type update(const rclcpp::Time&, const rclcpp::Duration&) = 0;
  std::shared_ptr<Node> get_node() { return node_; }

 protected:
  std::vector<hardware_interface::LoanedCommandInterface> command_interfaces_;
  std::vector<hardware_interface::LoanedStateInterface> state_interfaces_;

 private:
  std::shared_ptr<Node> node_ = std::make_shared<Node>();
};

}  // namespace controller_interface

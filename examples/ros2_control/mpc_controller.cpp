// A ros2_control controller around Prowl's predictive controller. Compiled against stubs here: see README.md.
#include <atomic>
#include <chrono>
#include <cmath>
#include <controller_interface/controller_interface.hpp>
#include <exception>
#include <mutex>
#include <optional>
#include <prowl/mpc/mpc_controller.hpp>
#include <prowl/mpc/plan_executor.hpp>
#include <prowl/mpc/stepping_patterns.hpp>
#include <prowl/task_file/robot_file.hpp>
#include <thread>

namespace prowl_ros2_control {

using controller_interface::CallbackReturn;
using controller_interface::interface_configuration_type;
using controller_interface::InterfaceConfiguration;
using controller_interface::return_type;

constexpr double kPeriod = 0.01;  // between two plans [s]
constexpr double kDelay = 0.012;  // from a measured state to the time at which its plan acts [s]
// State interfaces of the estimated base, in the order of q and v (docs/controller.md).
constexpr const char* kBase[] = {"position.x",        "position.y",        "position.z",         "orientation.x",
                                 "orientation.y",     "orientation.z",     "orientation.w",      "linear_velocity.x",
                                 "linear_velocity.y", "linear_velocity.z", "angular_velocity.x", "angular_velocity.y",
                                 "angular_velocity.z"};

class MpcController : public controller_interface::ControllerInterface {
 public:
  CallbackReturn on_init() override {
    get_node()->declare_parameter("robot_file", "");
    get_node()->declare_parameter("gait", "trot");
    return CallbackReturn::SUCCESS;
  }

  CallbackReturn on_configure(const rclcpp_lifecycle::State&) override try {
    const std::string file = get_node()->get_parameter("robot_file").as_string();
    robot_.emplace(prowl::load_robot(prowl::read_text_file(file), prowl::PackageSearch{}));
    feet_ = prowl::contacts_of_feet(*robot_);
    pattern_ = prowl::stepping_pattern(*robot_, feet_, prowl::standing_on_ground(*robot_).z(),
                                       get_node()->get_parameter("gait").as_string());
    seen_ = {0.0, robot_->nominal_configuration(), Eigen::VectorXd::Zero(robot_->nv()),
             std::vector<bool>(feet_.size(), true)};
    tau_.setZero(robot_->nu());
    return CallbackReturn::SUCCESS;
  } catch (const std::exception&) {  // log its what()
    return CallbackReturn::ERROR;
  }

  InterfaceConfiguration command_interface_configuration() const override {
    InterfaceConfiguration wanted{interface_configuration_type::INDIVIDUAL, {}};
    for (const std::string& joint : robot_->joint_names()) wanted.names.push_back(joint + "/effort");
    return wanted;
  }
  InterfaceConfiguration state_interface_configuration() const override {
    InterfaceConfiguration wanted{interface_configuration_type::INDIVIDUAL, {}};
    for (const char* name : kBase) wanted.names.push_back(std::string("base/") + name);
    for (const char* value : {"/position", "/velocity"})
      for (const std::string& joint : robot_->joint_names()) wanted.names.push_back(joint + value);
    for (const std::vector<int>& foot : feet_)
      wanted.names.push_back(robot_->contacts()[static_cast<std::size_t>(foot.front())].name + "/contact");
    return wanted;
  }

  /// The robot stands in its standing posture, anywhere: the controller begins there, without a command.
  CallbackReturn on_activate(const rclcpp_lifecycle::State&) override try {
    began_.reset();
    read(0.0, seen_);
    measured_ = seen_;
    wanted_ = {};
    prowl::MpcOptions options;
    options.delay = kDelay;
    mpc_.emplace(*robot_, options, seen_.q, seen_.v, 0.0);
    mpc_->follow(pattern_);
    executor_.emplace(*robot_, mpc_->latest());
    stops_ = false;
    planner_ = std::thread([this] { plan(); });
    return CallbackReturn::SUCCESS;
  } catch (const std::exception&) {
    return CallbackReturn::ERROR;
  }
  CallbackReturn on_deactivate(const rclcpp_lifecycle::State&) override {
    stops_ = true;
    if (planner_.joinable()) planner_.join();
    for (auto& interface : command_interfaces_) (void)interface.set_value(0.0);  // joints are free: hold the robot
    return CallbackReturn::SUCCESS;
  }

  return_type update(const rclcpp::Time& time, const rclcpp::Duration&) override {
    if (!began_) began_ = time.seconds();
    read(time.seconds() - *began_, seen_);
    if (const std::unique_lock guard(lock_, std::try_to_lock); guard) measured_ = seen_;  // never waits
    executor_->torque(seen_.t, seen_.q, seen_.v, tau_);
    bool ok = true;
    for (Eigen::Index j = 0; j < tau_.size(); ++j)
      ok &= command_interfaces_[static_cast<std::size_t>(j)].set_value(tau_(j));
    return ok ? return_type::OK : return_type::ERROR;
  }

  /// From a subscription to a twist, in any thread.
  void command(const prowl::MpcCommand& command) {
    const std::lock_guard guard(lock_);
    wanted_ = command;
  }

 private:
  struct State {
    double t = 0.0;
    Eigen::VectorXd q, v;
    std::vector<bool> touches;
  };

  void read(double t, State& state) const {
    std::size_t next = 0;
    const auto value = [&] { return state_interfaces_[next++].get_optional().value_or(std::nan("")); };
    state.t = t;
    for (int i = 0; i < 7; ++i) state.q(i) = value();
    for (int i = 0; i < 6; ++i) state.v(i) = value();
    for (int j = 0; j < robot_->nu(); ++j) state.q(7 + j) = value();
    for (int j = 0; j < robot_->nu(); ++j) state.v(6 + j) = value();
    for (std::size_t f = 0; f < state.touches.size(); ++f) state.touches[f] = value() > 0.5;
  }

  void plan() {
    State state;
    for (double next = 0.0; !stops_; std::this_thread::sleep_for(std::chrono::milliseconds(1))) {
      {
        const std::lock_guard guard(lock_);
        if (measured_.t < next) continue;
        next = measured_.t + kPeriod;
        state = measured_;
        mpc_->command(wanted_);
      }
      mpc_->feel_contacts(state.touches, state.t);
      if (mpc_->update(state.q, state.v, state.t)) executor_->offer(mpc_->latest());
    }
  }

  std::optional<prowl::RobotModel> robot_;
  std::vector<std::vector<int>> feet_;
  prowl::SteppingPattern pattern_;
  std::optional<prowl::MpcController> mpc_;
  std::optional<prowl::PlanExecutor> executor_;
  std::optional<double> began_;
  State seen_;
  Eigen::VectorXd tau_;
  std::mutex lock_;  // of the two below
  State measured_;
  prowl::MpcCommand wanted_;
  std::atomic<bool> stops_ = true;
  std::thread planner_;
};

}  // namespace prowl_ros2_control

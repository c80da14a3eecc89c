// The control loop of a robot with predictive control: torques every millisecond, a new plan every 10 ms by a second
// thread. MuJoCo stands in for the robot:  control_loop robots/hyq.toml [FOLDER of robot packages]
#include <atomic>
#include <chrono>
#include <iostream>
#include <mutex>
#include <prowl/mpc/mpc_controller.hpp>
#include <prowl/mpc/plan_executor.hpp>
#include <prowl/mpc/stepping_patterns.hpp>
#include <prowl/simulation/physics.hpp>
#include <prowl/task_file/robot_file.hpp>
#include <stdexcept>
#include <thread>

using namespace std::chrono_literals;

/// What a state estimator and switches in the feet tell, at a time.
struct Measured {
  double t = 0.0;
  Eigen::VectorXd q, v;
  std::vector<bool> touches;
};

int main(int count, char** arguments) try {
  if (count < 2) throw std::invalid_argument("usage: control_loop ROBOT_FILE [PACKAGES]");
  prowl::PackageSearch packages;
  if (count > 2) packages.folders = {arguments[2]};
  const prowl::RobotModel model = prowl::load_robot(prowl::read_text_file(arguments[1]), packages);
  prowl::MpcOptions options;
  options.delay = 0.012;  // from a measured state to the time at which its plan acts: 10 ms to plan, 2 ms reserve
  const Eigen::VectorXd standing = prowl::standing_on_ground(model);
  prowl::MpcController controller(model, options, standing, Eigen::VectorXd::Zero(model.nv()), 0.0);  // may throw
  const std::size_t num_feet = controller.feet().size();
  Measured now{0.0, standing, Eigen::VectorXd::Zero(model.nv()), std::vector<bool>(num_feet, true)};
  controller.follow(prowl::stepping_pattern(model, controller.feet(), standing.z(), "trot"));
  controller.command({.forward = 0.3});
  prowl::PlanExecutor executor(model, controller.latest());

  prowl::Physics robot(model, {prowl::Surface{.name = "ground", .friction = 0.6}}, {.step = 1e-3});
  robot.set_state(now.q, now.v);

  std::mutex lock;  // of now
  std::atomic<bool> stops = false;
  std::thread planner([&] {
    for (Measured seen; !stops; std::this_thread::sleep_for(1ms)) {
      {
        const std::lock_guard guard(lock);
        if (now.t < seen.t + 0.01) continue;
        seen = now;
      }
      controller.feel_contacts(seen.touches, seen.t);
      if (controller.update(seen.q, seen.v, seen.t)) executor.offer(controller.latest());
    }
  });

  const double least_load = 0.05 * model.weight() / static_cast<double>(num_feet);  // of a switch that closes
  Eigen::VectorXd tau(model.nu());
  const auto began = std::chrono::steady_clock::now();
  for (int tick = 0; tick < 5000; ++tick) {
    const double t = 1e-3 * tick;
    std::this_thread::sleep_until(began + std::chrono::duration<double>(t));
    if (const std::unique_lock guard(lock, std::try_to_lock); guard) {
      now.t = t;
      now.q = robot.q();
      now.v = robot.v();
      for (std::size_t f = 0; tick > 0 && f < num_feet; ++f)  // loads are known after the first step
        now.touches[f] = robot.contacts()[controller.feet()[f].front()].load > least_load;
    }
    executor.torque(t, robot.q(), robot.v(), tau);  // within the limits; no allocation, never waits
    if (!robot.step(tau)) break;
  }
  stops = true;
  planner.join();
  std::cout << "after 5 s: " << robot.q().x() - standing.x() << " m ahead, height " << robot.q().z() << " m\n";
  return 0;
} catch (const std::exception& error) {
  std::cerr << error.what() << '\n';
  return 2;
}

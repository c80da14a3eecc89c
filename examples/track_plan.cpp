// Torques of a robot's controller from a plan's gains:  track_plan out/hyq_crouch/tracker.bin
//
// In the place of the robot there is a state that is off the plan by 1 cm, so that feedback has something to do.
#include <iostream>
#include <prowl/tracker/tracker.hpp>

int main(int, char** arguments) try {
  const auto tracker = prowl::Tracker::read(arguments[1]);
  const int nu = tracker.plan().nu();
  Eigen::VectorXd q(7 + nu), v(6 + nu), tau(nu);

  for (double t = tracker.start(); t < tracker.end(); t += 0.001) {  // the controller's clock, 1 kHz
    tracker.reference(t, q, v);
    q(2) -= 0.01;
    tracker.torque(t, q, v, tau);  // tau*(t) + K(t) (x* ⊖ x), within the limits; no allocation, 2 us
    if (!tau.allFinite()) return 1;
  }
  std::cout << "last segment: " << tracker.segment(tracker.end()).name << '\n' << tau.transpose() << '\n';
  return 0;
} catch (const prowl::TrackerError& error) {
  std::cerr << error.what() << '\n';
  return 2;
}

#include "prowl/mpc/mpc_options.hpp"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "prowl/mpc/standing_robot.hpp"
#include "prowl/text/option_check.hpp"

namespace prowl {
namespace {

constexpr int kMostSteps = 200;
constexpr double kMostDelay = 0.5;  ///< [s]

void check_weights(const MpcWeights& w) {
  const std::pair<const char*, double> weights[] = {{"place", w.place},
                                                    {"height", w.height},
                                                    {"tilt", w.tilt},
                                                    {"heading", w.heading},
                                                    {"posture", w.posture},
                                                    {"posture_of_biped", w.posture_of_biped},
                                                    {"velocity", w.velocity},
                                                    {"climb", w.climb},
                                                    {"turning", w.turning},
                                                    {"joint_rate", w.joint_rate},
                                                    {"acceleration", w.acceleration},
                                                    {"torque", w.torque},
                                                    {"force", w.force},
                                                    {"terminal", w.terminal}};
  for (const auto& [name, value] : weights)
    check_option(value >= 0.0 && std::isfinite(value), std::string("weights.") + name, value, ">= 0");
  check_option(w.penalty > 0.0 && std::isfinite(w.penalty), "weights.penalty", w.penalty, "> 0");
}

}  // namespace

const MpcOptions& checked(const MpcOptions& options) {
  check_option(options.steps >= 2 && options.steps <= kMostSteps, "steps", options.steps, "2 to 200");
  check_option(options.steps_of_biped >= 2 && options.steps_of_biped <= kMostSteps, "steps_of_biped",
               options.steps_of_biped, "2 to 200");
  check_option(options.first_step > 0.0 && options.first_step <= 1.0, "first_step", options.first_step,
               "more than 0, at most 1 s");
  check_option(options.least_horizon > 0.0 && options.least_horizon <= 10.0, "least_horizon", options.least_horizon,
               "more than 0, at most 10 s");
  check_option(options.clearance > 0.0 && options.clearance <= 1.0, "clearance", options.clearance,
               "more than 0, at most 1");
  check_option(options.clearance_of_biped > 0.0 && options.clearance_of_biped <= 1.0, "clearance_of_biped",
               options.clearance_of_biped, "more than 0, at most 1");
  check_option(options.delay >= 0.0 && options.delay <= kMostDelay, "delay", options.delay, "0 to 0.5 s");
  check_option(options.iterations >= 1, "iterations", options.iterations, "1 or more");
  check_option(options.feedback_iterations >= 1, "feedback_iterations", options.feedback_iterations, "1 or more");
  check_option(options.barrier > 0.0 && std::isfinite(options.barrier), "barrier", options.barrier, "> 0");
  check_option(options.friction > 0.0 && std::isfinite(options.friction), "friction", options.friction, "> 0");
  check_weights(options.weights);
  return options;
}

MpcOptions options_for(const RobotModel& robot, const MpcOptions& options) {
  MpcOptions result = checked(options);
  if (contacts_of_feet(robot).size() == 2) {
    result.steps = options.steps_of_biped;
    result.clearance = options.clearance_of_biped;
    result.weights.posture = options.weights.posture_of_biped;
  }
  result.first_step = std::max(options.first_step, options.delay);
  return result;
}

}  // namespace prowl

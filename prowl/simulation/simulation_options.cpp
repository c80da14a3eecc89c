#include "prowl/simulation/simulation_options.hpp"

#include <fmt/format.h>

#include "prowl/text/option_check.hpp"

namespace prowl {

void check_simulation_options(const SimulationOptions& options, int nu) {
  const auto at_least_zero = [](const char* name, double value, const char* unit = "") {
    check_option(value >= 0.0 && std::isfinite(value), name, value, fmt::format("a finite number >= 0{}", unit));
  };
  check_option(options.control_rate >= 10.0 && options.control_rate <= 1e5, "control rate", options.control_rate,
               "10 to 1e5 Hz");
  check_option(options.delay >= 0.0 && options.delay <= 1.0, "delay", options.delay, "0 to 1 s");
  check_option(options.delay + options.unknown_delay >= 0.0 && options.unknown_delay <= 1.0, "unknown delay",
               options.unknown_delay, "at least minus the known delay, at most 1 s");
  at_least_zero("bandwidth", options.bandwidth, " Hz");
  at_least_zero("noise", options.noise_scale);
  at_least_zero("unknown noise", options.unknown_noise);
  at_least_zero("record rate", options.record_rate, " Hz");
  check_pushes(options.pushes);
  check_option(std::isfinite(options.ground.height) && options.ground.tilt.allFinite(), "ground", options.ground.height,
               "finite numbers");
  if (const auto& start = options.start) {
    const bool fits = start->joints.size() == 0 || start->joints.size() == nu;
    check_option(fits, "start error of joints", static_cast<double>(start->joints.size()), "one for each joint");
    check_option(start->base.allFinite() && start->twist.allFinite() && start->joints.allFinite(), "start error",
                 start->base.sum(), "finite numbers");
  }

  const PhysicsOptions& physics = options.physics;
  check_option(physics.step >= 1e-5 && physics.step <= 1e-2, "step", physics.step, "1e-5 to 1e-2 s");
  check_option(physics.mass_scale > 0.0 && std::isfinite(physics.mass_scale), "mass scale", physics.mass_scale, "> 0");
  const auto bodies = static_cast<std::size_t>(nu) + 1;
  check_option(physics.body_scales.empty() || physics.body_scales.size() == bodies, "body scales",
               static_cast<double>(physics.body_scales.size()), fmt::format("one for each of {} bodies", bodies));
  for (const double scale : physics.body_scales)
    check_option(scale > 0.0 && std::isfinite(scale), "body scale", scale, "> 0");
  check_option(physics.base_center.allFinite(), "centre of mass", physics.base_center.sum(), "finite numbers");
  at_least_zero("friction scale", physics.friction_scale);
  at_least_zero("friction", physics.friction.value_or(1.0));
}

}  // namespace prowl

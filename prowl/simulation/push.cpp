#include "prowl/simulation/push.hpp"

#include <fmt/format.h>

#include <cmath>

#include "prowl/error.hpp"

namespace prowl {

void check_pushes(const std::vector<Push>& pushes) {
  const auto need = [](bool is_allowed, const char* name, double value, const char* needed) {
    if (!is_allowed) throw InputError(fmt::format("{}: {} is not allowed; need {}", name, value, needed));
  };
  for (const Push& push : pushes) {
    need(push.time >= 0.0 && std::isfinite(push.time), "push time", push.time, "a finite number >= 0 s");
    need(push.duration > 0.0 && std::isfinite(push.duration), "push duration", push.duration, "a finite number > 0 s");
    need(push.impulse.allFinite(), "push impulse", push.impulse.sum(), "finite numbers");
  }
}

Eigen::Vector3d push_at(const std::vector<Push>& pushes, double t) {
  Eigen::Vector3d force = Eigen::Vector3d::Zero();
  for (const Push& push : pushes) {
    if (t >= push.time && t < push.time + push.duration) force += push.impulse / push.duration;
  }
  return force;
}

}  // namespace prowl

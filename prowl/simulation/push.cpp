#include "prowl/simulation/push.hpp"

#include <cmath>

#include "prowl/text/option_check.hpp"

namespace prowl {

void check_pushes(const std::vector<Push>& pushes) {
  for (const Push& push : pushes) {
    check_option(push.time >= 0.0 && std::isfinite(push.time), "push time", push.time, "a finite number >= 0 s");
    check_option(push.duration > 0.0 && std::isfinite(push.duration), "push duration", push.duration,
                 "a finite number > 0 s");
    check_option(push.impulse.allFinite(), "push impulse", push.impulse.sum(), "finite numbers");
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
